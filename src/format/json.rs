//! A reduced model as JSON: one object, matrices as lists of rows.

use super::arrays::{Array, arrays};
use crate::model::{ReducedModel, StateSpace};
use serde_json::{Map, Value, json};

/// The model (and its state space) as a JSON object with the names of `arrays`; every finite number
/// reads back to the same bits, one that is not finite is null.
pub fn reduced_to_json(model: &ReducedModel, state_space: Option<&StateSpace>) -> String {
    let mut object = Map::new();
    for (name, array) in arrays(model, state_space) {
        let value = match array {
            Array::Row(values) => json!(values),
            Array::Texts(texts) => json!(texts),
            Array::Matrix(m) => Value::Array(m.row_iter().map(|r| json!(r.iter().collect::<Vec<_>>())).collect()),
        };
        object.insert(name.to_owned(), value);
    }
    format!("{:#}\n", Value::Object(object))
}
