"""Loads the model files with programs that are not ours and compares them with the published kinematics.

Usage: model.py FOLDER forward-kinematics.csv, where FOLDER has the files of `handscope model --urdf --mjcf` of the right hand.
"""

import csv
import math
import sys

import mujoco
import numpy as np
import yourdfpy

FOLDER, POSES = sys.argv[1], sys.argv[2]
DRIVES = ["little_1", "ring_1", "middle_1", "index_1", "thumb_2", "thumb_1"]
LINKS = ["little_2", "ring_2", "middle_2", "index_2", "thumb_2", "thumb_3", "thumb_4"]
TOUCH = ["little", "ring", "middle", "index", "thumb"]
WITHIN_MM = 0.1
# A coupled joint may give so much under load, rad.
GIVES = 0.02


def poses():
    with open(POSES, newline="") as lines:
        rows = list(csv.reader(lines))[1:]
    for row in rows:
        numbers = [float(cell) for cell in row]
        yield numbers[:6], np.array(numbers[6:]).reshape(-1, 3)


def urdf():
    robot = yourdfpy.URDF.load(f"{FOLDER}/ftp_right_hand.urdf", build_collision_scene_graph=True)
    assert len(robot.actuated_joint_names) == 6, robot.actuated_joint_names
    worst = 0.0
    for angles, wanted in poses():
        robot.update_cfg({f"right_{name}_joint": angle for name, angle in zip(DRIVES, angles)})
        names = [f"right_{name}" for name in LINKS] + [f"right_{name}_touch" for name in TOUCH]
        for name, place in zip(names, wanted):
            at = robot.get_transform(name, "right_palm")[:3, 3] * 1000
            worst = max(worst, float(np.linalg.norm(at - place)))
    assert worst < WITHIN_MM, worst
    print(f"urdf: {worst:.3f} mm at most from the published kinematics")
    return robot


def masses(robot):
    """Each link weighs and turns as MuJoCo computes it from the shapes."""
    model = mujoco.MjModel.from_xml_path(f"{FOLDER}/ftp_right_hand.xml")
    whole = 0.0
    for name, link in robot.link_map.items():
        if link.inertial is None:
            continue
        body = model.body(name)
        inertia = np.array(link.inertial.inertia)
        assert np.allclose(inertia, inertia.T) and (np.linalg.eigvalsh(inertia) > 0).all(), name
        moments = np.sort(np.linalg.eigvalsh(inertia))
        assert moments[2] < moments[0] + moments[1], name
        assert abs(link.inertial.mass - float(body.mass[0])) < 1e-5, name
        assert np.allclose(moments, np.sort(body.inertia), rtol=1e-3), (name, moments, body.inertia)
        assert np.allclose(link.inertial.origin[:3, 3], body.ipos, atol=1e-6), name
        whole += link.inertial.mass
    assert abs(whole - float(model.body_mass.sum())) < 2e-4, whole
    print(f"urdf: {whole:.3f} kg, as in mjcf")


def coupling(model):
    """Each coupled joint, the one it follows, and the ratio."""
    for nth in range(model.neq):
        yield model.eq_obj1id[nth], model.eq_obj2id[nth], model.eq_data[nth][1]


def mjcf():
    model = mujoco.MjModel.from_xml_path(f"{FOLDER}/ftp_right_hand.xml")
    data = mujoco.MjData(model)
    assert (model.nu, model.njnt, model.neq) == (6, 12, 6), (model.nu, model.njnt, model.neq)
    worst = 0.0
    for angles, wanted in poses():
        for name, angle in zip(DRIVES, angles):
            data.joint(f"right_{name}_joint").qpos[0] = angle
        # The followers that follow others come last.
        for follows, leads, ratio in coupling(model):
            data.qpos[model.jnt_qposadr[follows]] = ratio * data.qpos[model.jnt_qposadr[leads]]
        mujoco.mj_kinematics(model, data)
        places = [data.body(f"right_{name}").xpos for name in LINKS]
        places += [data.site(f"right_{name}_touch").xpos for name in TOUCH]
        for at, place in zip(places, wanted):
            worst = max(worst, float(np.linalg.norm(at * 1000 - place)))
    assert worst < WITHIN_MM, worst
    print(f"mjcf: {worst:.3f} mm at most from the published kinematics")
    under_load(model)


def under_load(model):
    """Half closed, with 10 N on each fingertip against the way of closing: what is coupled stays coupled."""
    data = mujoco.MjData(model)
    ends = model.actuator_ctrlrange[:, 1]
    gives = moved = 0.0
    for step in range(3000):
        data.ctrl[:] = ends * 0.5
        if step >= 1000:
            for finger in TOUCH:
                site = data.site(f"right_{finger}_touch")
                body = model.site_bodyid[site.id]
                out = -site.xmat.reshape(3, 3)[:, 0] * -10.0
                torque = np.cross(site.xpos - data.xipos[body], out)
                data.xfrc_applied[body][:3] = out
                data.xfrc_applied[body][3:] = torque
        mujoco.mj_step(model, data)
        assert np.isfinite(data.qpos).all(), step
        if step == 999:
            before = data.qpos.copy()
            off = max(abs(data.joint(model.actuator(n).trnid[0]).qpos[0] - ends[n] * 0.5) for n in range(6))
            assert off < 0.1, off
        if step > 300:
            for follows, leads, ratio in coupling(model):
                angle = data.qpos[model.jnt_qposadr[follows]]
                other = data.qpos[model.jnt_qposadr[leads]]
                gives = max(gives, abs(angle - ratio * other))
    moved = float(np.abs(data.qpos - before).max())
    assert gives < GIVES, gives
    assert moved > 0.01, f"the load does nothing: {moved}"
    print(f"mjcf: coupled joints give {gives:.4f} rad under 10 N at each tip, which moves joints by {moved:.3f} rad")


masses(urdf())
mjcf()
