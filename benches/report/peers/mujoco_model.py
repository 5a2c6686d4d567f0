"""A scene of the report as a model of MuJoCo, in reduced coordinates.

Bodies hang in a tree: each on the first connector that leads to it from the world, with the origin of its frame there, and
with all joints at 0 at the start. A pin that is left over closes a loop, by an equality constraint. What moves freely has
no place here, and neither have rails and springs.

A drive is a rotor of enormous inertia in the joint (`armature`), that starts at the rate: it keeps it, whatever its
mechanism does. A motor is either an actuator with a bounded force, or (form "friction") what a bounded motor is in
mechanics: dry friction against a rotor that turns at the motor's speed.
"""

import math
from dataclasses import dataclass

# Inertia of a rotor [kg m^2, or kg]: so much that a mechanism of some kilograms turns it by less than 1e-10 in seconds.
ROTOR = 1e12
# Tolerance of the solver, by default and where it is set for accuracy: its steps are Newton's.
STOCK_TOLERANCE, TOLERANCE = 1e-8, 1e-12
# Mass of a rotor's body, which must have one [kg].
ROTOR_MASS = 1e-9
# Half the thickness of walls, across the plane [m].
DEPTH = 0.5


class Unsupported(Exception):
    """The scene has something that this model does not know."""


@dataclass
class Tuning:
    """Settings of a run: see `mujoco_runs.py`."""

    integrator: str
    motors: str
    step: float
    stiff: bool
    share: float = 1.0
    # Time constant [s] and damping ratio of constraints, if they are stiff.
    time_constant: float = 0.0
    damping: float = 1.0


@dataclass
class Link:
    """A body in the tree: its connector, its parent (None for the world), and its own point of the connector."""

    connector: int
    parent: int | None
    point: tuple
    outer: tuple


def rotated(point, angle):
    cos, sin = math.cos(angle), math.sin(angle)
    return (cos * point[0] - sin * point[1], sin * point[0] + cos * point[1])


def tree(scene):
    """The link of each body, and the pins that close loops."""
    links, loops, todo = {}, [], list(range(len(scene["connectors"])))
    for index in list(todo):
        joint = scene["connectors"][index]["joint"]
        if joint is None:
            raise Unsupported("such connectors")
        if "slider" in joint:
            links[joint["slider"]["body"]] = Link(index, None, (0.0, 0.0), tuple(joint["slider"]["point"]))
            todo.remove(index)
    while todo:
        grown = False
        for index in list(todo):
            a, b = scene["connectors"][index]["joint"]["pin"]
            for inner, outer in ((b, a), (a, b)):
                known = outer["body"] is None or outer["body"] in links
                if known and inner["body"] is not None and inner["body"] not in links:
                    links[inner["body"]] = Link(index, outer["body"], tuple(inner["point"]), tuple(outer["point"]))
                    todo.remove(index)
                    grown = True
                    break
            if grown:
                break
        if not grown:
            loops, todo = todo, []
    if len(links) != len(scene["bodies"]) or scene["springs"]:
        raise Unsupported("bodies without joints, or springs")
    return links, loops


def inertia_at_joint(scene, body, link):
    """Inertia of a body alone about its joint, by which the gain of an actuator is chosen."""
    told = scene["bodies"][body]
    if "slider" in scene["connectors"][link.connector]["joint"]:
        return told["mass"]
    return told["moment"] + told["mass"] * (link.point[0] ** 2 + link.point[1] ** 2)


class Model:
    """The text of a model, with the joints' rates at the start in the order of the joints."""

    def __init__(self, scene, tuning):
        self.scene, self.tuning = scene, tuning
        self.links, self.loops = tree(scene)
        self.rates, self.controls, self.actuators, self.tendons = [], [], [], []
        bodies = "".join(self.body(body) for body, link in self.links.items() if link.parent is None)
        gravity = scene["gravity"]
        # The solver's tolerance counts in the mean inertia; with rotors in that it would stop at once.
        has_rotor = "armature" in bodies
        tolerance = TOLERANCE if tuning.stiff else STOCK_TOLERANCE
        if has_rotor:
            tolerance *= self.mean_inertia() / ROTOR
        contact = "enable" if scene["collisions"] else "disable"
        solver = ""
        if tuning.stiff:
            solver = f'solref="{tuning.time_constant!r} {tuning.damping!r}" solimp="0.9999 0.9999 0.001"'
        limit = solver.replace("solref", "solreflimit").replace("solimp=", "solimplimit=")
        friction = solver.replace("solref", "solreffriction").replace("solimp=", "solimpfriction=")
        self.text = f"""<mujoco>
  <compiler angle="radian" autolimits="false"/>
  <option timestep="{tuning.step!r}" integrator="{tuning.integrator}" gravity="{gravity[0]!r} {gravity[1]!r} 0" tolerance="{tolerance!r}">
    <flag contact="{contact}"/>
  </option>
  <default>
    <joint {limit} {friction}/>
    <equality {solver}/>
    <tendon {limit}/>
    <geom {solver} condim="1" contype="0" conaffinity="0"/>
  </default>
  <worldbody>{bodies}</worldbody>
  <equality>{"".join(self.loop(index) for index in self.loops)}</equality>
  <tendon>{"".join(self.tendons)}</tendon>
  <actuator>{"".join(self.actuators)}</actuator>
</mujoco>"""

    def mean_inertia(self):
        inertias = [inertia_at_joint(self.scene, body, link) for body, link in self.links.items()]
        return sum(inertias) / len(inertias)

    def coordinate(self, body):
        """Coordinate of a body's joint at the start, its rate there, and the axis."""
        link, told = self.links[body], self.scene["bodies"][body]["start"]
        joint = self.scene["connectors"][link.connector]["joint"]
        if "slider" in joint:
            axis, point = joint["slider"]["axis"], joint["slider"]["point"]
            along = lambda v: axis[0] * v[0] + axis[1] * v[1]
            way = along([x - y for x, y in zip(told["position"], point)])
            return way, along(told["velocity"]), "slide", (axis[0], axis[1], 0.0), 1.0
        outer = {"angle": 0.0, "angular_velocity": 0.0}
        if link.parent is not None:
            outer = self.scene["bodies"][link.parent]["start"]
        turn = told["angle"] - outer["angle"]
        rate = told["angular_velocity"] - outer["angular_velocity"]
        # The coordinate is that of the pin's second body less the first.
        sign = 1.0 if joint["pin"][1]["body"] == body else -1.0
        return turn, rate, "hinge", (0.0, 0.0, 1.0), sign

    def body(self, body):
        scene, tuning, link = self.scene, self.tuning, self.links[body]
        told, acts = scene["bodies"][body], scene["connectors"][link.connector]
        at, rate, kind, axis, sign = self.coordinate(body)
        joint = f'name="j{body}" type="{kind}" axis="{axis[0]!r} {axis[1]!r} {axis[2]!r}"'
        if kind == "slide":
            place, turn = told["start"]["position"], 0.0
        elif link.parent is None:
            place, turn = link.outer, at
        else:
            parent = self.links[link.parent].point
            place, turn = (link.outer[0] - parent[0], link.outer[1] - parent[1]), at
        frame = f'pos="{place[0]!r} {place[1]!r} 0" quat="{math.cos(turn / 2)!r} 0 0 {math.sin(turn / 2)!r}"'
        limits = ""
        if acts["limits"]:
            lower, upper = sorted(sign * limit - at for limit in acts["limits"])
            limits = f' limited="true" range="{lower!r} {upper!r}"'
        if acts["friction"]:
            joint += f' frictionloss="{acts["friction"]!r}"'
        if acts["rate"] is not None:
            joint += f' armature="{ROTOR!r}"'
        before, after = "", ""
        motor = acts["motor"]
        if motor and tuning.motors == "friction":
            # The rotor is between the parent and the body, which then counts from the rotor.
            speed = sign * motor["speed"]
            rotor = f'name="r{body}" type="{kind}" axis="{axis[0]!r} {axis[1]!r} {axis[2]!r}" armature="{ROTOR!r}"'
            mass = f'<inertial pos="0 0 0" mass="{ROTOR_MASS!r}" diaginertia="{ROTOR_MASS!r} {ROTOR_MASS!r} {ROTOR_MASS!r}"/>'
            before, after = f"<body {frame}><joint {rotor}/>{mass}", "</body>"
            frame = 'pos="0 0 0"'
            joint += f' frictionloss="{motor["most"]!r}"'
            if limits:
                both = f'<joint joint="r{body}" coef="1"/><joint joint="j{body}" coef="1"/>'
                self.tendons.append(f"<fixed{limits}>{both}</fixed>")
                limits = ""
            self.rates.append(speed)
            rate -= speed
        elif motor:
            gain = tuning.share * inertia_at_joint(scene, body, link) / tuning.step
            most = motor["most"]
            self.actuators.append(
                f'<general joint="j{body}" gainprm="{gain!r}" biastype="affine" biasprm="0 0 {-gain!r}" '
                f'forcelimited="true" forcerange="{-most!r} {most!r}"/>'
            )
            self.controls.append(sign * motor["speed"])
        self.rates.append(rate)
        center, moment = (-link.point[0], -link.point[1]), told["moment"]
        inertial = f'<inertial pos="{center[0]!r} {center[1]!r} 0" mass="{told["mass"]!r}" diaginertia="{moment!r} {moment!r} {moment!r}"/>'
        inner = "".join(self.body(child) for child, other in self.links.items() if other.parent == body)
        shape = self.shape(told["shape"], center) if scene["collisions"] else ""
        return f'{before}<body name="b{body}" {frame}><joint {joint}{limits}/>{inertial}{shape}{inner}</body>{after}'

    def shape(self, shape, center):
        """Discs as spheres, which touch walls in the plane; straight edges as boxes behind them."""
        if shape and "disc" in shape:
            return f'<geom type="sphere" size="{shape["disc"]!r}" pos="{center[0]!r} {center[1]!r} 0" contype="1"/>'
        if not shape or not shape.get("lines"):
            raise Unsupported("such shapes")
        walls, corners = "", shape["lines"]
        shortest = min(math.dist(a, b) for a, b in zip(corners, corners[1:]))
        for a, b in zip(corners, corners[1:] + corners[:1]):
            length = math.dist(a, b)
            along = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
            # The solid is on the left.
            half = 0.5 * shortest
            middle = [0.5 * (a[0] + b[0]) - half * along[1] + center[0], 0.5 * (a[1] + b[1]) + half * along[0] + center[1]]
            turn = math.atan2(along[1], along[0])
            walls += (
                f'<geom type="box" size="{0.5 * length!r} {half!r} {DEPTH!r}" pos="{middle[0]!r} {middle[1]!r} 0" '
                f'quat="{math.cos(turn / 2)!r} 0 0 {math.sin(turn / 2)!r}" conaffinity="1"/>'
            )
        return walls

    def loop(self, index):
        a, b = self.scene["connectors"][index]["joint"]["pin"]
        if a["body"] is None:
            a, b = b, a
        point = self.links[a["body"]].point
        anchor = (a["point"][0] - point[0], a["point"][1] - point[1])
        other = "" if b["body"] is None else f' body2="b{b["body"]}"'
        return f'<connect body1="b{a["body"]}"{other} anchor="{anchor[0]!r} {anchor[1]!r} 0"/>'
