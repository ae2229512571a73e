//! The transfer functions that methods are compared on, as control points: each is hard for methods of another kind.

/// Scalar and linear RGB: from blue over white, where there is a kink, to orange.
pub(crate) const COLOR: [[f64; 4]; 3] = [[0.0, 0.1, 0.2, 0.9], [0.5, 0.9, 0.9, 0.8], [1.0, 0.9, 0.2, 0.1]];

/// Name, and scalar with extinction.
pub(crate) fn extinctions() -> [(&'static str, Vec<[f64; 2]>); 5] {
    let tent = |center: f64, half: f64, height: f64| [[center - half, 0.0], [center, height], [center + half, 0.0]];
    let tents = [tent(0.2, 0.05, 50.0), tent(0.5, 0.05, 50.0), tent(0.8, 0.05, 50.0)].concat();
    let edge = 1.0 / 256.0;
    // Multiples of the golden ratio: spread evenly, and in no order once the factor is squared.
    let noise = |i: u32| (f64::from(i) * 0.618_033_988_75).fract();
    let table = (0..256).map(|i| [f64::from(i) / 255.0, 10.0 * noise(i * i)]).collect();
    [
        ("ramp", vec![[0.0, 0.0], [1.0, 10.0]]),
        ("tents", tents),
        ("shell", tent(0.5, 1.0 / 128.0, 400.0).to_vec()),
        ("box", vec![[0.3, 0.0], [0.3 + edge, 20.0], [0.7, 20.0], [0.7 + edge, 0.0]]),
        ("table", table),
    ]
}
