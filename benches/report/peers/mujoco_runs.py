"""Runs the scenes of the report in MuJoCo and writes rows of its table.

    cargo bench -p halfgap-report --bench speed_vs_error -- --write-scenes SCENES
    python3 benches/report/peers/mujoco_runs.py SCENES mujoco.csv [--only NAME]... [--longest SECONDS]
    cargo bench -p halfgap-report --bench speed_vs_error -- --engine none --merge mujoco.csv

It needs `mujoco` and `numpy`. Steps, checks, errors and repeats are those of the report's other peers: steps of 1/60 s and
shorter by factors of four (RK4 from 1/15 s), as long as a run takes less than 8 s; the largest error at the check times; the least time of
`mj_step` alone, which is called once for all steps between two checks.

Each step is run with all as it comes (`stock`: Euler, with the defaults of constraints), and with constraints as stiff as
the step allows (`stiff`: `solref` of two steps or less, `solimp` 0.9999; the numbers are the time constant in steps and the
damping ratio) with each integrator. Motors are run in both forms of `mujoco_model.py`; the gain of an actuator is a multiple
of the inertia over the step.
"""

import argparse
import csv
import json
import math
import pathlib
import time

import mujoco
import numpy

from mujoco_model import Model, Tuning, Unsupported

HEAD = (
    "scene,engine,version,settings,wall_seconds_per_simulated_second,steps,events,error_m,"
    "reference_error_m,largest_penetration_m,connector_error_m,energy_error_j,status"
)
STOCK_RATE, REFINEMENT, REFINEMENTS = 60.0, 4.0, 6
INTEGRATORS = ("Euler", "implicitfast", "RK4", "discrete")
# Rules for repeats, as in the report: their number, their time together, and the longest run [s].
MOST, PATIENCE, LONGEST = 101, 0.4, 8.0


class Run:
    """A scene with settings, from its start."""

    def __init__(self, scene, tuning):
        self.scene = scene
        self.built = Model(scene, tuning)
        self.model = mujoco.MjModel.from_xml_string(self.built.text)
        self.data = mujoco.MjData(self.model)
        self.bodies = [self.model.body(f"b{body}").id for body in range(len(scene["bodies"]))]
        self.reset()

    def reset(self):
        mujoco.mj_resetData(self.model, self.data)
        self.data.qvel[:] = self.built.rates
        if self.built.controls:
            self.data.ctrl[:] = self.built.controls
        self.steps = 0

    def advance(self, until):
        """Steps to a time; the time that this took."""
        count = round(until / self.model.opt.timestep) - self.steps
        started = time.perf_counter()
        mujoco.mj_step(self.model, self.data, count)
        wall = time.perf_counter() - started
        self.steps += count
        return wall

    def poses(self):
        mujoco.mj_kinematics(self.model, self.data)
        for body in self.bodies:
            x, y, _ = self.data.xipos[body]
            frame = self.data.xmat[body]
            yield (x, y), math.atan2(frame[3], frame[0])

    def energy_error(self):
        """Kinetic energy and that of gravity, less that of the states that are known at the last check [J]."""
        scene = self.scene
        mujoco.mj_forward(self.model, self.data)
        found, known, velocity = 0.0, 0.0, numpy.zeros(6)
        for told in scene["checks"][-1]["states"]:
            body, state = scene["bodies"][told["body"]], told["state"]
            id = self.bodies[told["body"]]
            mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_BODY, id, velocity, 0)
            found += energy(scene, body, self.data.xipos[id][:2], velocity[3:5], velocity[2])
            known += energy(scene, body, state["position"], state["velocity"], state["angular_velocity"])
        return found - known

    def is_lost(self):
        return any(warning.number for warning in self.data.warning)


def energy(scene, body, place, velocity, rate):
    kinetic = body["mass"] * (velocity[0] ** 2 + velocity[1] ** 2) + body["moment"] * rate**2
    weight = scene["gravity"][0] * place[0] + scene["gravity"][1] * place[1]
    return float(0.5 * kinetic - body["mass"] * weight)


def error(scene, check, poses):
    """Largest error of a position, and of a turn times the radius of gyration [m]."""
    worst = 0.0
    for known in check["states"]:
        body, state = scene["bodies"][known["body"]], known["state"]
        place, angle = poses[known["body"]]
        turn = (angle - state["angle"] + math.pi) % math.tau - math.pi
        lever = math.sqrt(body["moment"] / body["mass"])
        worst = max(worst, math.dist(place, state["position"]), lever * abs(turn))
    return worst if math.isfinite(worst) else math.inf


def placed(end, poses):
    if end["body"] is None:
        return end["point"]
    (x, y), angle = poses[end["body"]]
    cos, sin = math.cos(angle), math.sin(angle)
    px, py = end["point"]
    return (x + cos * px - sin * py, y + sin * px + cos * py)


def connector_error(scene, poses):
    pins = (connector["joint"]["pin"] for connector in scene["connectors"] if "pin" in connector["joint"])
    return max((math.dist(placed(a, poses), placed(b, poses)) for a, b in pins), default=0.0)


def measure(scene, tuning, patience):
    """A row's numbers: time per second, steps, error, penetration, error of connectors, of the energy."""
    run = Run(scene, tuning)
    wall, worst, parted, depth = 0.0, 0.0, 0.0, 0.0
    for check in scene["checks"]:
        wall += run.advance(check["time"])
        poses = list(run.poses())
        worst = max(worst, error(scene, check, poses))
        parted = max(parted, connector_error(scene, poses))
        depth = max([depth] + [-contact.dist for contact in run.data.contact])
    if run.is_lost() or not math.isfinite(worst):
        raise ArithmeticError("it becomes unstable")
    off = run.energy_error()
    least, began = wall, time.perf_counter()
    for _ in range(MOST):
        if time.perf_counter() - began + least > patience:
            break
        run.reset()
        least = min(least, sum(run.advance(check["time"]) for check in scene["checks"]))
    return least / scene["duration"], run.steps, worst, depth, parted, off


def stiff(integrator, motors, share, steps, damping):
    return lambda step: Tuning(integrator, motors, step, True, share, steps * step, damping)


def tunings(scene):
    """Ways in which a step is run: name of settings, and the tuning for the step."""
    has_motor = any(connector["motor"] for connector in scene["connectors"])
    forms = [("actuator", 0.9), ("actuator", 100.0), ("friction", 1.0)] if has_motor else [("", 1.0)]
    for motors, share in forms:
        form = f" {motors}" + (f" {share}" if motors == "actuator" else "") if motors else ""
        yield f"stock{form}", lambda step, m=motors, s=share: Tuning("Euler", m, step, False, s)
        for integrator in INTEGRATORS:
            # Time constants in steps, and damping ratios; the integrator `discrete` takes any time constant.
            pairs = [(2.0, 1.0), (2.0, 10.0)] + ([(1e-3, 1.0)] if integrator == "discrete" else [])
            for steps, damping in pairs:
                yield f"stiff {steps:g} {damping:g} {integrator}{form}", stiff(integrator, motors, share, steps, damping)


def rows(scene, longest, patience):
    for name, make in tunings(scene):
        # RK4 is of a higher order: a longer step may do.
        for refinement in range(-1 if "RK4" in name else 0, REFINEMENTS + 1):
            count = math.ceil(STOCK_RATE * REFINEMENT**refinement * scene["grid"])
            settings = f"{name} steps {count}"
            row = [scene["name"], "mujoco", mujoco.__version__, settings]
            try:
                wall, steps, worst, depth, parted, off = measure(scene, make(scene["grid"] / count), patience)
            except Unsupported as why:
                yield row + ["", "", "", "", f"{scene['reference_error']:e}", "", "", "", f"mujoco has no {why}"]
                break
            except (ArithmeticError, mujoco.FatalError) as why:
                yield row + ["", "", "", "", f"{scene['reference_error']:e}", "", "", "", f"stopped early: {why}"]
                continue
            numbers = [f"{wall:e}", steps, "", f"{worst:e}", f"{scene['reference_error']:e}", f"{depth:e}", f"{parted:e}"]
            yield row + numbers + [f"{off:e}", "done"]
            if REFINEMENT * wall * scene["duration"] > longest:
                break


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--longest", type=float, default=LONGEST)
    parser.add_argument("--patience", type=float, default=PATIENCE)
    options = parser.parse_args()
    with options.out.open("w", newline="") as file:
        file.write(HEAD + "\n")
        writer = csv.writer(file, lineterminator="\n")
        for path in sorted(options.scenes.glob("*.json")):
            scene = json.loads(path.read_text())
            if options.only and not any(part in scene["name"] for part in options.only):
                continue
            for row in rows(scene, options.longest, options.patience):
                writer.writerow(row)
                file.flush()
                print(*row[:1], *row[3:5], row[7], row[12])


if __name__ == "__main__":
    main()
