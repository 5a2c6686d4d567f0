//! The reference engine's pair detection: each of its records is one of our feature pairs, with the same gap
//! and normal.
//!
//! `docs/geometry-reference.md` explains the classes that are counted here.

use crate::reference::{data, items, number, shapes, vector};
use halfgap_geometry::{DVec2, Feature, FeatureKind, GapSample, Pose, Shape};
use serde_json::Value;
use std::collections::BTreeMap;

/// Largest difference [m] of gaps, and of normals, that agree.
const TOLERANCE: f64 = 1e-6;
/// The distance [m] within which the reference reports a contact.
const DISTANCE_TOL: f64 = 0.01;
/// Bound above the deepest penetration [m] in the data.
const DEEPEST: f64 = 0.016;

/// A body of a case, in coordinates about the reference's centre of mass.
struct Body {
    shape: Shape,
    pose: Pose,
}

fn body(value: &Value, all: &[(String, Value, Shape)]) -> Body {
    let (_, reference, shape) =
        all.iter().find(|(name, ..)| value["shape"] == **name).expect("a known shape");
    let pose = Pose::new(vector(&value["position"]), number(&value["angle"]));
    Body { shape: shape.translated(-vector(&reference["center_of_mass"])), pose }
}

/// One of our gaps, with the kinds of its features, lesser first, and the normal from `b` to `a`.
struct Ours {
    kinds: (FeatureKind, FeatureKind),
    sample: GapSample,
    normal: DVec2,
    /// Center of the arc that is the normal side, if it is one.
    arc_center: Option<DVec2>,
}

fn all_gaps(a: &Body, b: &Body) -> Vec<Ours> {
    let pairs = a.shape.features().iter().flat_map(|p| b.shape.features().iter().map(move |q| (p, q)));
    let sampled = pairs.filter_map(|(p, q)| {
        let sample = GapSample::measure(p, &a.pose, q, &b.pose)?;
        let normal = if sample.primary_is_a { sample.normal } else { -sample.normal };
        let (kind_a, kind_b) = (p.kind(), q.kind());
        let normal_side = if sample.primary_is_a { q } else { p };
        let arc_center = matches!(normal_side, Feature::Round(_)).then_some(sample.center_normal);
        let kinds = (kind_a.min(kind_b), kind_a.max(kind_b));
        Some(Ours { kinds, sample, normal, arc_center })
    });
    sampled.collect()
}

/// Class of a record compared with the best of our gaps, and the index of that gap.
fn classify(record: &Value, ours: &[Ours]) -> (String, usize) {
    let distance = number(&record["distance"]);
    let sign = if record["first"] == "a" { 1.0 } else { -1.0 };
    let normal = vector(&record["normal"]) * sign;
    let impact = vector(&record["impact"]);
    let fits = |gap: &&(usize, &Ours)| (gap.1.sample.gap - distance).abs() < TOLERANCE;
    let mut listed: Vec<(usize, &Ours)> = ours.iter().enumerate().collect();
    listed.sort_by_key(|(_, gap)| !gap.sample.is_valid());
    let same_gap: Vec<&(usize, &Ours)> = listed.iter().filter(fits).collect();
    let same = same_gap.iter().find(|(_, gap)| (gap.normal - normal).length() < TOLERANCE);
    let what =
        |gap: &Ours| format!("{} {:?}-{:?}", record["kind"].as_str().unwrap_or(""), gap.kinds.0, gap.kinds.1);
    if let Some((index, gap)) = same {
        let beyond = if gap.sample.is_valid() { "" } else { ", outside the normal cone of the vertex" };
        return (format!("{}: same gap and normal{beyond}", what(gap)), *index);
    }
    // The normal of the arc where the vertex came through it, not where it is now.
    let at_crossing = same_gap.iter().find(|(_, gap)| {
        gap.arc_center.is_some_and(|center| {
            let away = (impact - center).normalize();
            (away - normal).length().min((away + normal).length()) < TOLERANCE
        })
    });
    let (index, gap) = at_crossing.unwrap_or_else(|| panic!("no feature pair for {record}"));
    (format!("{}: same gap, normal where the path of the vertex crossed the arc", what(gap)), *index)
}

#[test]
fn every_record_of_the_reference_is_a_feature_pair() {
    let all = shapes();
    let pairs = data(include_str!("../data/pair_detection.json"));
    let mut records: BTreeMap<String, u32> = BTreeMap::new();
    let (mut unlisted, mut corners_with_curvature) = (0, 0);
    for pair in items(&pairs["pairs"]) {
        let (a, b) = (body(&pair["a"], &all), body(&pair["b"], &all));
        let ours = all_gaps(&a, &b);
        let mut used: Vec<usize> = Vec::new();
        for record in items(&pair["found"]) {
            let (class, index) = classify(record, &ours);
            *records.entry(class).or_default() += 1;
            used.push(index);
            let is_corner = record["kind"] == "CornerEdge";
            corners_with_curvature += u32::from(is_corner && record["radius_first"].is_number());
        }
        for (index, gap) in ours.iter().enumerate() {
            let is_near = gap.sample.gap <= DISTANCE_TOL && gap.sample.gap >= -DEEPEST;
            unlisted += u32::from(is_near && gap.sample.is_valid() && !used.contains(&index));
        }
    }
    let crossed = "same gap, normal where the path of the vertex crossed the arc";
    let expected = [
        ("CornerEdge Vertex-ConcaveArc: same gap and normal".to_owned(), 4),
        (format!("CornerEdge Vertex-ConcaveArc: {crossed}"), 4),
        ("CornerEdge Vertex-ConvexArc: same gap and normal".to_owned(), 17),
        (format!("CornerEdge Vertex-ConvexArc: {crossed}"), 17),
        ("CornerEdge Vertex-Line: same gap and normal".to_owned(), 60),
        ("CornerEdge Vertex-Line: same gap and normal, outside the normal cone of the vertex".to_owned(), 2),
        ("EdgeEdge ConvexArc-ConcaveArc: same gap and normal".to_owned(), 10),
        ("EdgeEdge ConvexArc-ConvexArc: same gap and normal".to_owned(), 32),
        ("EdgeEdge ConvexArc-Line: same gap and normal".to_owned(), 60),
    ];
    assert_eq!(records, BTreeMap::from(expected));
    assert_eq!(unlisted, 0, "feature pairs of ours that the reference does not list");
    assert_eq!(corners_with_curvature, 16);
}
