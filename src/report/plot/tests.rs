//! Whole pictures: the same bytes twice, and any data without a panic.

use super::*;

fn curve(x: Vec<f64>, y: Vec<f64>) -> Curve {
    Curve { label: "a<b>&".into(), x, y, colour: Colour::Blue, stroke: Stroke::Solid }
}

fn plot(curves: Vec<Curve>) -> Plot {
    Plot {
        title: "Receptance \"z\" <d>".into(),
        x: Axis::log("ω (rad/s)"),
        y: Axis::log("|H| (m/N)"),
        curves,
        ..Plot::default()
    }
}

#[test]
fn the_same_plot_gives_the_same_bytes() {
    let x: Vec<f64> = (1..5000).map(f64::from).collect();
    let y = x.iter().map(|w| 1e-3 / (1.0 - (w / 300.0) * (w / 300.0)).abs().max(1e-3)).collect();
    let p = plot(vec![curve(x, y)]);
    let (a, b) = (draw(&p).expect("drawn"), draw(&p).expect("drawn"));
    assert!(a == b);
    assert!(a.png.starts_with(b"\x89PNG") && a.png.len() < 300_000, "{} bytes", a.png.len());
    assert!(a.svg.starts_with("<svg role=\"img\" aria-label=\"Receptance &quot;z&quot; &lt;d&gt;\" width=\"900\""));
    assert!(a.svg.contains("a&lt;b&gt;&amp;") && !a.svg.contains("<b>"));
}

#[test]
fn degenerate_data_gives_a_picture_or_an_error() {
    let nan = f64::NAN;
    let nothing = |c| assert!(matches!(draw(&plot(c)), Err(PlotError::Nothing { .. })));
    nothing(vec![]);
    nothing(vec![curve(vec![], vec![])]);
    nothing(vec![curve(vec![1.0, nan], vec![nan, 1.0])]);
    nothing(vec![curve(vec![0.0, -1.0], vec![1.0, 1.0])]);
    let lengths = draw(&plot(vec![curve(vec![1.0], vec![])]));
    assert_eq!(lengths, Err(PlotError::Lengths { curve: "a<b>&".into(), x: 1, y: 0 }));

    let drawn = |c| assert!(draw(&plot(c)).is_ok());
    drawn(vec![curve(vec![1.0], vec![1.0])]);
    drawn(vec![curve(vec![1.0, 10.0], vec![2.0, 2.0])]);
    drawn(vec![curve(vec![1.0, 2.0, nan, 3.0], vec![1.0, nan, 1.0, f64::INFINITY])]);
    drawn(vec![curve(vec![1e-300, 1e300], vec![1e-300, 1e300])]);
    drawn(vec![curve(vec![1.0, 1.0 + 1e-14], vec![1.0, 1.0 + 1e-14])]);

    let mut linear = plot(vec![curve(vec![1.0, 2.0], vec![-1e300, 1e300])]);
    (linear.x, linear.y) = (Axis::linear(""), Axis::linear(""));
    assert!(draw(&linear).is_ok());
    linear.curves[0].y = vec![f64::MAX, -f64::MAX];
    assert!(matches!(draw(&linear), Err(PlotError::Range { .. })));
    linear.curves[0].y = vec![1e-310, 2e-310];
    assert!(draw(&linear).is_ok());
    linear.curves[0].y = vec![1e15, 1e15 + 0.25];
    assert!(draw(&linear).is_ok());
}

#[test]
fn what_lies_outside_a_given_range_is_not_drawn() {
    let mut p = plot(vec![curve(vec![1.0, 100.0], vec![1.0, 1e9])]);
    p.x.range = Some((1.0, 10.0));
    p.y.range = Some((0.5, 10.0));
    let outside =
        Marker { x: 50.0, y: 1.0, label: "far".into(), colour: Colour::Ink, symbol: Symbol::Disc, always_named: true };
    p.markers.push(outside);
    let svg = draw(&p).expect("drawn").svg;
    assert!(!svg.contains("far"));
}
