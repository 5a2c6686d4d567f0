//! The connectors of a scene.

use super::bodies::Bodies;
use super::force::anchor;
use super::shape::edge_spec;
use crate::builder::WorldBuilder;
use crate::connector::{ConnectorSpec, JointSpring, Limits, Motor, OnCoordinate};
use crate::scene::{
    self, AxisFrame, ConnectorData, FieldPath, GearData, JointSpringData, LengthData, LimitsData, MotorData,
    NormalFrame, PointData, PulleyData, RackData, Scene, SceneError, SliderData, SlotData, WeldData,
};
use halfgap_collision::{Connector, ConnectorError, ConnectorKind, RailError, RailPath, SlotFrame, Turn};
use std::sync::Arc;

/// Default elasticity of bilateral connectors.
const HOLDING_ELASTICITY: f64 = 0.0;
/// Default elasticity of ropes and stops, before that of their bodies limits it.
const LIMITING_ELASTICITY: f64 = 1.0;

/// Adds all connectors; all bodies have been added before, in the order of the scene.
pub(super) fn add_all(builder: &mut WorldBuilder, bodies: &Bodies<'_>) -> Result<(), SceneError> {
    let scene = bodies.scene;
    let mut paths = Paths { scene, made: Vec::new() };
    for (index, data) in scene.connectors.iter().enumerate() {
        let field = FieldPath::top().field("connector").element(index).field(data.key());
        let kind = kind(builder, bodies, data, &mut paths, &field)?;
        let options = data.options();
        let elasticity = options.elasticity.unwrap_or(default_elasticity(bodies, data));
        let connector = Connector::new(kind, elasticity).map_err(|error| refused(&error, &field))?;
        builder.add_connector(ConnectorSpec {
            name: data.name.clone(),
            connector,
            collide: options.collide,
            align: options.align,
            on_coordinate: on_coordinate(data, &field)?,
        });
    }
    Ok(())
}

/// Returns the elasticity of a connector that gives none. Ropes and stops have the lesser elasticity of their bodies,
/// like two bodies that meet.
fn default_elasticity(bodies: &Bodies<'_>, data: &ConnectorData) -> f64 {
    let of_body =
        |point: &PointData| bodies.data(&point.body).map_or(LIMITING_ELASTICITY, |body| body.elasticity);
    match data {
        ConnectorData::Rope(rope) => of_body(&rope.a).min(of_body(&rope.b)),
        ConnectorData::RailStop(stop) => of_body(&stop.a),
        ConnectorData::Pulley(pulley) => of_body(&pulley.a).min(of_body(&pulley.b)),
        _ => HOLDING_ELASTICITY,
    }
}

fn kind<'a>(
    builder: &WorldBuilder,
    bodies: &Bodies<'a>,
    data: &'a ConnectorData,
    paths: &mut Paths<'a>,
    field: &FieldPath,
) -> Result<ConnectorKind, SceneError> {
    let end = |point: &PointData| anchor(builder, bodies, point);
    let ends = |length: &LengthData| (end(&length.a), end(&length.b), length.length);
    Ok(match data {
        ConnectorData::Pin(pin) => ConnectorKind::Pin { a: end(&pin.a), b: end(&pin.b) },
        ConnectorData::Slot(SlotData { a, b, normal, normal_frame, .. }) => ConnectorKind::Slot {
            a: end(a),
            b: end(b),
            normal: (*normal).into(),
            frame: match normal_frame {
                NormalFrame::A => SlotFrame::A,
                NormalFrame::B => SlotFrame::B,
                NormalFrame::World => SlotFrame::World,
            },
        },
        ConnectorData::Rod(data) => {
            let (a, b, length) = ends(data);
            ConnectorKind::Rod { a, b, length }
        }
        ConnectorData::Rope(data) => {
            let (a, b, length) = ends(data);
            ConnectorKind::Rope { a, b, length }
        }
        ConnectorData::Rail(rail) => {
            ConnectorKind::Rail { a: end(&rail.a), path: paths.find(&rail.path, rail.closed, field)? }
        }
        ConnectorData::RailStop(stop) => {
            let closed = paths.is_closed(&stop.path);
            let path = paths.find(&stop.path, closed, field)?;
            ConnectorKind::RailStop { a: end(&stop.a), path, at: stop.at, upper: stop.upper }
        }
        ConnectorData::Weld(WeldData { a, b, .. }) => {
            ConnectorKind::Weld { a: end(a), b: end(b), turn: Turn::default() }
        }
        ConnectorData::Slider(SliderData { a, b, axis, axis_frame, .. }) => ConnectorKind::Slider {
            a: end(a),
            b: end(b),
            axis: (*axis).into(),
            frame: match axis_frame {
                AxisFrame::A => SlotFrame::A,
                AxisFrame::World => SlotFrame::World,
            },
            turn: Turn::default(),
        },
        ConnectorData::Gear(GearData { a, b, ratio, carrier, .. }) => {
            let [a, b, carrier] = [a, b, carrier].map(|name| bodies.find(name));
            ConnectorKind::Gear { a, b, carrier, ratio: *ratio, turn: Turn::default() }
        }
        ConnectorData::Rack(RackData { wheel, bar, radius, axis, .. }) => {
            let [wheel, bar] = [wheel, bar].map(|name| bodies.find(name));
            ConnectorKind::Rack { wheel, bar, radius: *radius, axis: (*axis).into(), at: 0.0 }
        }
        ConnectorData::Pulley(PulleyData { a, b, wheel_a, wheel_b, ratio, length, .. }) => {
            let wheels = [(*wheel_a).into(), (*wheel_b).into()];
            ConnectorKind::Pulley { a: end(a), b: end(b), wheels, ratio: *ratio, length: *length }
        }
    })
}

/// What acts on the free coordinate of a connector.
fn on_coordinate(data: &ConnectorData, field: &FieldPath) -> Result<OnCoordinate, SceneError> {
    let Some(joint) = data.joint() else { return Ok(OnCoordinate::default()) };
    let law = joint.drive.map(|drive| {
        drive.to_law().map_err(|(place, error)| {
            let field = field.field("drive").field("table").field(place);
            SceneError::new(field, error.to_string())
        })
    });
    Ok(OnCoordinate {
        motor: joint.motor.map(|MotorData { speed, max }| Motor { speed, max }),
        friction: joint.friction.1,
        limits: joint.limits.map(|LimitsData { lower, upper, elasticity }| Limits {
            lower,
            upper,
            elasticity,
        }),
        drive: law.transpose()?,
        spring: joint.spring.map(|JointSpringData { rest, stiffness, damping }| JointSpring {
            rest,
            stiffness,
            damping,
        }),
    })
}

/// Paths of rails that have been made: a rail and its stops share one.
struct Paths<'a> {
    scene: &'a Scene,
    made: Vec<(&'a scene::RailPath, bool, Arc<RailPath>)>,
}

impl<'a> Paths<'a> {
    fn find(
        &mut self,
        data: &'a scene::RailPath,
        closed: bool,
        field: &FieldPath,
    ) -> Result<Arc<RailPath>, SceneError> {
        if let Some((.., path)) = self.made.iter().find(|made| made.0 == data && made.1 == closed) {
            return Ok(path.clone());
        }
        let path = rail_path(data, closed);
        let path = path.map_err(|error| SceneError::new(field.field("path"), error.to_string()))?;
        if closed && !path.is_closed() {
            let message =
                "the rail is said to be closed, but its last edge does not end where the first starts";
            return Err(SceneError::new(field.field("path"), message));
        }
        let path = Arc::new(path);
        self.made.push((data, closed, path.clone()));
        Ok(path)
    }

    /// True if a rail with this path is closed; stops do not repeat that field.
    fn is_closed(&self, data: &scene::RailPath) -> bool {
        let closed = |one: &ConnectorData| matches!(one, ConnectorData::Rail(rail) if rail.closed && rail.path == *data);
        self.scene.connectors.iter().any(|one| closed(&one.data))
    }
}

fn rail_path(data: &scene::RailPath, closed: bool) -> Result<RailPath, RailError> {
    if let Some(points) = &data.points {
        let points: Vec<_> = points.iter().map(|&point| point.into()).collect();
        return RailPath::through(&points, closed);
    }
    let edges: Vec<_> = data.edges.iter().flatten().map(edge_spec).collect();
    RailPath::from_edges(data.start.unwrap_or_default().into(), &edges)
}

/// Returns the error of a connector as that of the field to blame.
fn refused(error: &ConnectorError, field: &FieldPath) -> SceneError {
    let field = match error {
        ConnectorError::BadLength(_) => field.field("length"),
        ConnectorError::BadNormal(..) => field.field("normal"),
        ConnectorError::BadAxis(..) => field.field("axis"),
        ConnectorError::BadRatio(_) => field.field("ratio"),
        ConnectorError::BadRadius(_) => field.field("radius"),
        ConnectorError::BadElasticity(_) => field.field("elasticity"),
        ConnectorError::BadStop { .. } => field.field("at"),
        _ => field.clone(),
    };
    SceneError::new(field, error.to_string())
}
