//! Derivatives by central differences.

/// First derivative at 0 by the central difference of order 8.
pub(crate) fn first<
    T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
>(
    f: impl Fn(f64) -> T,
    h: f64,
) -> T {
    let pair = |k: f64, weight: f64| (f(k * h) - f(-k * h)) * (weight / h);
    pair(1.0, 4.0 / 5.0) + pair(2.0, -1.0 / 5.0) + pair(3.0, 4.0 / 105.0) + pair(4.0, -1.0 / 280.0)
}

/// Second derivative at 0 by the central difference of order 8.
pub(crate) fn second(f: impl Fn(f64) -> f64, h: f64) -> f64 {
    let middle = f(0.0);
    let pair = |k: f64, weight: f64| ((f(k * h) - middle) + (f(-k * h) - middle)) * (weight / (h * h));
    pair(1.0, 8.0 / 5.0) + pair(2.0, -1.0 / 5.0) + pair(3.0, 8.0 / 315.0) + pair(4.0, -1.0 / 560.0)
}
