//! Reduced models handed on: JSON, .mat, .npz.

use super::Folder;
use super::reduced::sample;
use ferrom::format::{detect, reduced_to_json, reduced_to_mat5, reduced_to_npz};
use ferrom::model::StateSpace;
use std::collections::BTreeMap;

fn u16_at(bytes: &[u8], at: usize) -> usize {
    usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]))
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]) as usize
}

fn doubles(bytes: &[u8]) -> Vec<f64> {
    bytes.chunks_exact(8).map(|c| f64::from_le_bytes(c.try_into().expect("eight bytes"))).collect()
}

#[test]
fn exports_are_told_by_content_and_the_same_model_gives_the_same_bytes() {
    let folder = Folder::new();
    let model = sample(3, true);
    let make = || {
        let mat = reduced_to_mat5(&model, None).expect("writable");
        let npz = reduced_to_npz(&model, None).expect("writable");
        [("mat", mat), ("npz", npz), ("json", reduced_to_json(&model, None).into_bytes())]
    };
    assert_eq!(make(), make());
    for (name, bytes) in make() {
        let found = detect(&folder.write("file", bytes)).expect("readable");
        assert_eq!(found.map(|f| f.name), Some(name));
    }
}

#[test]
fn json_numbers_read_back_to_the_bit() {
    let model = sample(3, true);
    let space = StateSpace::new(&model, &[2], &[2, 8]);
    let text = reduced_to_json(&model, Some(&space));
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    // The text is exact; serde_json's own reader may be off by one unit in the last place.
    let words = text.split([',', '\n', ' ']).filter_map(|word| word.parse::<f64>().ok());
    let written: std::collections::BTreeSet<u64> = words.map(f64::to_bits).collect();
    assert!(model.shapes.iter().all(|v| written.contains(&v.to_bits())));
    assert_eq!(value["shapes"].as_array().map(Vec::len), Some(9));
    assert!((value["shapes"][8][2].as_f64().expect("a number") - model.shapes[(8, 2)]).abs() < 1e-16);
    assert_eq!(value["name"][0], "sämple");
    assert_eq!(value["dof_axis"][8], "z");
    assert_eq!(value["A"].as_array().map(Vec::len), Some(6));
    assert_eq!(value["outputs"][5], "tip:z m/s2");
}

/// Walks the central directory as `zipfile` does. Checked once with NumPy: `numpy.load("a.npz")`
/// gives the same arrays.
#[test]
fn npz_members_hold_the_arrays() {
    let model = sample(3, true);
    let bytes = reduced_to_npz(&model, None).expect("writable");
    let end = bytes.len() - 22;
    assert_eq!(&bytes[end..end + 4], b"PK\x05\x06");
    let mut at = u32_at(&bytes, end + 16);
    let mut members = BTreeMap::new();
    for _ in 0..u16_at(&bytes, end + 10) {
        assert_eq!(&bytes[at..at + 4], b"PK\x01\x02");
        let (crc, size, name) = (u32_at(&bytes, at + 16), u32_at(&bytes, at + 24), u16_at(&bytes, at + 28));
        let local = u32_at(&bytes, at + 42);
        let data = &bytes[local + 30 + name..local + 30 + name + size];
        let mut sum = flate2::Crc::new();
        sum.update(data);
        assert_eq!(sum.sum() as usize, crc);
        let key = String::from_utf8(bytes[at + 46..at + 46 + name].to_vec()).expect("a name");
        assert_eq!(&bytes[local + 30..local + 30 + name], key.as_bytes());
        members.insert(key, data.to_vec());
        at += 46 + name;
    }
    assert_eq!(at, end);
    let shapes = &members["shapes.npy"];
    let header = 10 + u16_at(shapes, 8);
    assert_eq!(header % 64, 0);
    let text = String::from_utf8_lossy(&shapes[10..header]);
    assert!(text.contains("'<f8'") && text.contains("(9, 3)") && text.ends_with('\n'), "{text}");
    assert_eq!(doubles(&shapes[header..]), model.shapes.transpose().as_slice(), "row by row");
    let names = &members["name.npy"];
    let letters: Vec<char> =
        names[10 + u16_at(names, 8)..].chunks_exact(4).filter_map(|c| char::from_u32(u32_at(c, 0) as u32)).collect();
    assert_eq!(letters.iter().collect::<String>(), "sämple");
}

/// Walks the elements by their tags. Checked once with SciPy: `scipy.io.loadmat("a.mat")` gives the
/// same variables.
#[test]
fn mat_variables_hold_the_arrays() {
    let model = sample(3, true);
    let bytes = reduced_to_mat5(&model, None).expect("writable");
    assert_eq!(&bytes[124..128], [0x00, 0x01, b'I', b'M']);
    let mut at = 128;
    let mut variables = BTreeMap::new();
    while at < bytes.len() {
        assert_eq!(u32_at(&bytes, at), 14);
        let body = &bytes[at + 8..at + 8 + u32_at(&bytes, at + 4)];
        let size = (u32_at(body, 24), u32_at(body, 28));
        let name = String::from_utf8(body[40..40 + u32_at(body, 36)].to_vec()).expect("a name");
        let data = 40 + u32_at(body, 36).next_multiple_of(8);
        let values = body[data + 8..data + 8 + u32_at(body, data + 4)].to_vec();
        variables.insert(name, (u32_at(body, 8), size, values));
        at += 8 + body.len();
    }
    assert_eq!(at, bytes.len());
    let (class, size, values) = &variables["shapes"];
    assert_eq!((*class, *size), (6, (9, 3)));
    assert_eq!(doubles(values), model.shapes.as_slice(), "column by column");
    let (class, size, values) = &variables["dof_axis"];
    assert_eq!((*class, *size, values.len()), (4, (9, 2), 36));
    assert_eq!(variables["omega"].1, (1, 3));
}
