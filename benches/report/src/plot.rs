//! Pictures: time over error, both logarithmic, an engine a colour.
//!
//! Faint dots are all runs; the line joins those than which none is both faster and better. Left and low is good.

use crate::gas::GasRow;
use crate::sweep::Row;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::error::Error;

/// Errors [m] that the axis spans; what is outside is drawn at its end.
const ERRORS: (f64, f64) = (1e-13, 10.0);
/// Times [ms per simulated second] that the axis spans.
const TIMES: (f64, f64) = (2e-4, 2e3);
/// Engines and their colours, which people with any colour vision can tell apart.
const ENGINES: [(&str, RGBColor); 4] = [
    ("halfgap", RGBColor(0, 114, 178)),
    ("rapier", RGBColor(213, 94, 0)),
    ("box2d", RGBColor(0, 158, 115)),
    ("mujoco", RGBColor(204, 121, 167)),
];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Cost of an impact over the number of discs, and a cost that grows as its logarithm, from the same start.
///
/// # Errors
/// It cannot be drawn.
pub fn gas(rows: &[GasRow]) -> Result<String, Box<dyn Error>> {
    let discs = rows.iter().filter(|row| row.shape == "discs");
    let costs: Vec<(f64, f64)> = discs.map(|row| (row.count as f64, 1e6 * row.per_impact)).collect();
    let highest = costs.iter().map(|(_, cost)| *cost).fold(1.0, f64::max);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (600, 380)).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(50)
            .build_cartesian_2d((80.0..12_500.0).log_scale(), 0.0..1.5 * highest)?;
        let mut mesh = chart.configure_mesh();
        mesh.disable_mesh().x_desc("discs in the box").y_desc("us per impact");
        mesh.label_style(("sans-serif", 14)).draw()?;
        let color = ENGINES[0].1;
        chart.draw_series(LineSeries::new(costs.iter().copied(), color.stroke_width(2)))?;
        chart.draw_series(costs.iter().map(|&cost| Circle::new(cost, 4, color.filled())))?;
        if let Some(&(first, cost)) = costs.first() {
            let logarithm = costs.iter().map(|&(count, _)| (count, cost * count.ln() / first.ln()));
            chart
                .draw_series(LineSeries::new(logarithm, BLACK.mix(0.4)))?
                .label("growing as log N")
                .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], BLACK.mix(0.4)));
        }
        let mut labels = chart.configure_series_labels();
        labels.position(SeriesLabelPosition::UpperLeft).label_font(("sans-serif", 14)).draw()?;
        root.present()?;
    }
    Ok(text)
}

/// Sizes [pixel] of a panel's parts.
struct Style {
    title: u32,
    label: u32,
    dot: i32,
    described: bool,
}

/// The picture of one scene as SVG.
///
/// # Errors
/// It cannot be drawn.
pub fn scene(rows: &[Row], name: &str) -> Result<String, Box<dyn Error>> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (720, 500)).into_drawing_area();
        root.fill(&WHITE)?;
        panel(&root, rows, name, &Style { title: 20, label: 14, dot: 3, described: true })?;
        root.present()?;
    }
    Ok(text)
}

/// The picture of all scenes with known answers, four in a row.
///
/// # Errors
/// It cannot be drawn.
pub fn overview(rows: &[Row], names: &[String]) -> Result<String, Box<dyn Error>> {
    const COLUMNS: usize = 4;
    const PANEL: (u32, u32) = (270, 225);
    const HEAD: u32 = 50;
    let lines = names.len().div_ceil(COLUMNS);
    let size = (PANEL.0 * COLUMNS as u32, PANEL.1 * lines as u32 + HEAD);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE)?;
        let (head, body) = root.split_vertically(HEAD);
        draw_head(&head, &engines_of(rows, names))?;
        let style = Style { title: 15, label: 11, dot: 2, described: false };
        for (area, name) in body.split_evenly((lines, COLUMNS)).iter().zip(names) {
            panel(area, rows, name, &style)?;
        }
        root.present()?;
    }
    Ok(text)
}

/// The engines that ran on any of the scenes, with their colours.
fn engines_of(rows: &[Row], names: &[String]) -> Vec<(&'static str, RGBColor)> {
    let ran = |engine: &str| rows.iter().any(|row| row.engine == engine && names.contains(&row.scene));
    ENGINES.into_iter().filter(|(engine, _)| ran(engine)).collect()
}

fn draw_head(area: &Area<'_>, engines: &[(&str, RGBColor)]) -> Result<(), Box<dyn Error>> {
    let text = "time of stepping [ms per simulated second] over largest error of a position [m]; left and low is good";
    area.draw(&Text::new(text, (12, 10), ("sans-serif", 15)))?;
    for (place, &(engine, color)) in (0..).zip(engines) {
        let x = 16 + 110 * place;
        area.draw(&Circle::new((x, 38), 4, color.filled()))?;
        area.draw(&Text::new(engine, (x + 10, 31), ("sans-serif", 15)))?;
    }
    Ok(())
}

fn panel(area: &Area<'_>, rows: &[Row], name: &str, style: &Style) -> Result<(), Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .caption(name.replace('_', " "), ("sans-serif", style.title))
        .margin(6)
        .margin_right(18)
        .x_label_area_size(2 * style.label + 6)
        .y_label_area_size(4 * style.label)
        .build_cartesian_2d((ERRORS.0..ERRORS.1).log_scale(), (TIMES.0..TIMES.1).log_scale())?;
    let mut mesh = chart.configure_mesh();
    mesh.disable_mesh()
        .x_labels(if style.described { 14 } else { 5 })
        .y_labels(6)
        .x_label_formatter(&|error| format!("{error:.0e}"))
        .y_label_formatter(&|time| format!("{time}"))
        .label_style(("sans-serif", style.label));
    if style.described {
        mesh.x_desc("largest error of a position [m]").y_desc("ms per simulated second");
    }
    mesh.draw()?;
    for (engine, color) in engines_of(rows, &[name.to_owned()]) {
        let runs = runs_of(rows, name, engine);
        let dots = runs.iter().map(|&run| Circle::new(run, style.dot - 1, color.mix(0.5).filled()));
        chart.draw_series(dots)?;
        let best = frontier(runs);
        let line = chart.draw_series(LineSeries::new(best.iter().copied(), color.stroke_width(2)))?;
        if style.described {
            line.label(engine).legend(move |(x, y)| Circle::new((x + 10, y), 4, color.filled()));
        }
        chart.draw_series(best.iter().map(|&run| Circle::new(run, style.dot, color.filled())))?;
    }
    if style.described {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .label_font(("sans-serif", style.label))
            .draw()?;
    }
    Ok(())
}

/// Errors and times of an engine's runs, within the axes.
fn runs_of(rows: &[Row], scene: &str, engine: &str) -> Vec<(f64, f64)> {
    let runs = rows.iter().filter(|row| row.scene == scene && row.engine == engine);
    let runs = runs.filter_map(Row::time_and_error);
    runs.map(|(time, error)| (error.clamp(ERRORS.0, ERRORS.1), (1e3 * time).clamp(TIMES.0, TIMES.1)))
        .collect()
}

/// The runs than which none is both faster and better, from the fastest.
fn frontier(mut runs: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    runs.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
    let mut least = f64::INFINITY;
    runs.retain(|&(error, _)| {
        let is_better = error < least;
        least = least.min(error);
        is_better
    });
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frontier_leaves_out_what_is_beaten() {
        let runs = vec![(1e-2, 1.0), (1e-3, 2.0), (2e-3, 3.0), (1e-5, 4.0), (1e-2, 0.5)];
        assert_eq!(frontier(runs), [(1e-2, 0.5), (1e-3, 2.0), (1e-5, 4.0)]);
    }
}
