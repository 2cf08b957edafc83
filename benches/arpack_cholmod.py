"""The lowest modes by ARPACK in shift-invert mode with a CHOLMOD factor; one JSON object."""
import gzip
import json
import resource
import sys
import time

import numpy as np
import scipy.io
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from sksparse.cholmod import cholesky


def read(path):
    with gzip.open(path) as stream:
        return scipy.io.mmread(stream).tocsc()


k, m = read(sys.argv[1]), read(sys.argv[2])
count, sigma = int(sys.argv[3]), float(sys.argv[4])
start = np.random.default_rng(0).random(k.shape[0])
wall, cpu = time.perf_counter(), time.process_time()
factor = cholesky((k - sigma * m).tocsc())
operator = sla.LinearOperator(k.shape, matvec=factor, dtype=float)
values, shapes = sla.eigsh(k, k=count, M=m, sigma=sigma, OPinv=operator, tol=1e-10, v0=start)
wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
order = np.argsort(values)
values, shapes = values[order], shapes[:, order]
force = k @ shapes
residual = np.linalg.norm(force - (m @ shapes) * values, axis=0) / np.linalg.norm(force, axis=0)
print(json.dumps({"wall_s": wall, "cpu_s": cpu, "peak_mb": peak, "residual": float(residual[6:].max())}))
