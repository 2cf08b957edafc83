#!/bin/bash
# Compares `cargo bench --bench eigen` with ARPACK + CHOLMOD (scipy, scikit-sparse) on the same files.
#
#   benches/against_arpack.sh FOLDER [modes] [NAME:SHIFT ...]
#
# FOLDER holds NAME.stiffness.mtx.gz and NAME.mass.mtx.gz. The peer is installed into its own
# environment, target/peer (Debian: libsuitesparse-dev is needed to build scikit-sparse); it is told
# a good shift, ours finds its own. Reading the files is not counted on either side.
set -e
root=$(cd "$(dirname "$0")/.." && pwd)
folder=$1; modes=${2:-56}; shift $(( $# < 2 ? $# : 2 ))
cases=("$@"); [ ${#cases[@]} -gt 0 ] || cases=(leaf-60k:-1e4 bracket-50k:-1e6)
peer=$root/target/peer
if [ ! -x "$peer/bin/python" ]; then
    python3 -m venv "$peer"
    "$peer/bin/pip" install -q numpy scipy "scikit-sparse==0.4.16"
fi
cd "$root" && cargo build --release --bench eigen 2>/dev/null
bench=$(ls -t target/release/deps/eigen-* | grep -v '\.d$' | head -1)
for case in "${cases[@]}"; do
    name=${case%%:*}; sigma=${case##*:}
    k=$folder/$name.stiffness.mtx.gz; m=$folder/$name.mass.mtx.gz
    echo "== $name, $modes modes (load $(cut -d' ' -f1 /proc/loadavg))"
    export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
    theirs=$("$peer/bin/python" "$root/benches/arpack_cholmod.py" "$k" "$m" "$modes" "$sigma")
    one=$("$bench" "$k" "$m" "$modes" 1)
    two=$("$bench" "$k" "$m" "$modes" 2)
    "$peer/bin/python" - "$theirs" "$one" "$two" <<'PYTHON'
import json, sys
theirs, one, two = map(json.loads, sys.argv[1:])
row = "{:22s} {:>8.2f} {:>8.2f} {:>8.0f} {:>10.1e} {:>9s}".format
print("{:22s} {:>8s} {:>8s} {:>8s} {:>10s} {:>9s}".format("", "wall s", "CPU s", "peak MB", "residual", "complete"))
for name, r in (("ARPACK + CHOLMOD", theirs), ("ferrom, 1 thread", one), ("ferrom, 2 threads", two)):
    print(row(name, r["wall_s"], r["cpu_s"], r["peak_mb"], r["residual"], str(r.get("proved", "-"))))
print(f"ratio of CPU time {one['cpu_s']/theirs['cpu_s']:.2f}, of peak memory {one['peak_mb']/theirs['peak_mb']:.2f}, "
      f"wall 2 threads / 1 thread {two['wall_s']/one['wall_s']:.2f}")
print("stages, 1 thread:", ", ".join(f"{s['name']} {s['wall_s']:.2f}" for s in one["stages"]))
PYTHON
done
