//! Results over time.

use ferrom::format::{trajectory_to_csv, trajectory_to_h5};
use ferrom::model::{Channel, Energy, Extreme, Stats, Trajectory};

fn channel(name: &str, values: Vec<f64>) -> Channel {
    let end = Extreme { t: 0.1, value: -0.2 };
    let (datum, at_rest) = ("start".into(), Some(-0.0536));
    Channel { name: name.into(), unit: "m".into(), datum, values, at_rest, extremes: vec![end], range: [end, end] }
}

fn run(time: Vec<f64>, channels: Vec<Channel>, wall_s: f64) -> Trajectory {
    Trajectory {
        scene: "drop".into(),
        time,
        channels,
        energy: Some(Energy { input: vec![("gravity".into(), 1.5)], ..Energy::default() }),
        effects: vec!["gravity".into()],
        stats: Stats { steps: 2, wall_s, ..Stats::default() },
        warnings: vec![],
    }
}

#[test]
fn csv_numbers_read_back_to_the_bit() {
    let values = vec![1.0 / 3.0, -1e-17];
    let text =
        trajectory_to_csv(&run(vec![0.0, 1e-4], vec![channel("pin, z", values.clone()), channel("d", vec![])], 1.0));
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time [s],\"pin, z [m]\",d [m]"));
    for (line, value) in lines.zip(&values) {
        let back: f64 = line.split(',').nth(1).expect("a cell").parse().expect("a number");
        assert_eq!(back.to_bits(), value.to_bits());
    }
}

#[test]
fn a_static_analysis_has_one_line() {
    let text = trajectory_to_csv(&run(vec![], vec![channel("pin", vec![])], 1.0));
    assert_eq!(text, "time [s],pin [m]\n,-0.0536\n");
}

#[test]
fn hdf5_holds_values_by_time_and_channel_and_no_wall_time() {
    let channels = || vec![channel("a", vec![1.0, 2.0, 3.0]), channel("b", vec![4.0, 5.0, 6.0])];
    let bytes = trajectory_to_h5(&run(vec![0.0, 0.1, 0.2], channels(), 1.0)).expect("writable");
    assert_eq!(bytes, trajectory_to_h5(&run(vec![0.0, 0.1, 0.2], channels(), 2.0)).expect("writable"));
    let file = hdf5_pure::File::from_bytes(bytes).expect("HDF5");
    let values = file.dataset("values").expect("there");
    assert_eq!(values.shape().expect("shape"), [3, 2]);
    assert_eq!(values.read_f64().expect("numbers"), [1.0, 4.0, 2.0, 5.0, 3.0, 6.0]);
    assert_eq!(file.dataset("channels/name").and_then(|d| d.read_string()).expect("names"), ["a", "b"]);
    assert_eq!(file.dataset("energy/input").and_then(|d| d.read_f64()).expect("joules"), [1.5]);
    assert!(trajectory_to_h5(&run(vec![], vec![channel("a", vec![])], 1.0)).is_ok());
}
