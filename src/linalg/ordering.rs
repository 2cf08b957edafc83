//! Fill-reducing orderings and the choice among them.

use super::graph::NodeGraph;
use super::tree::EliminationTree;
use feral_ordering_core::CscPattern;

/// Work below which a second ordering cannot pay for itself: multilevel dissection takes about as
/// long as this many operations of factorisation.
const WORTH_DISSECTION: f64 = 2e9;

/// The cheapest of minimum fill (Amestoy, AMF) and multilevel nested dissection (Karypis & Kumar)
/// by operation count; dissection is only tried where the factorisation is dear enough. Returns
/// the tree and the name of the winner.
pub(super) fn cheapest(graph: &NodeGraph) -> (EliminationTree, &'static str) {
    let natural = || (0..graph.vertices() as u32).collect::<Vec<u32>>();
    let start: Option<Vec<i32>> = graph.start.iter().map(|&s| i32::try_from(s).ok()).collect();
    let next: Vec<i32> = graph.next.iter().map(|&v| v as i32).collect();
    let pattern = start.as_ref().and_then(|start| CscPattern::new(graph.vertices(), start, &next));
    let Some(pattern) = pattern else {
        return (EliminationTree::new(graph, &natural()), "natural");
    };
    let tree = |order: Vec<i32>| {
        let order: Vec<u32> = order.into_iter().map(|v| v as u32).collect();
        EliminationTree::new(graph, &order)
    };
    let fill = match feral_amf::amf_order(&pattern) {
        Ok(order) => tree(order),
        Err(_) => EliminationTree::new(graph, &natural()),
    };
    let work = fill.flops(graph);
    if work > WORTH_DISSECTION
        && let Ok(order) = feral_metis::metis_order(&pattern)
    {
        let dissection = tree(order);
        if dissection.flops(graph) < work {
            return (dissection, "nested dissection");
        }
    }
    (fill, "minimum fill")
}
