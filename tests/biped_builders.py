"""Bipeds of a few boxes for tests: legs of any joints, feet of any shapes, heads or none."""

from pathlib import Path

AXES = {"yaw": "0 0 1", "roll": "1 0 0", "pitch": "0 1 0"}
RANGES = {"yaw": "-0.8 0.8", "roll": "-0.7 0.7", "pitch": "-2 1.2"}
BOX_FOOT = '<geom type="box" size="0.06 0.035 0.01" pos="0.015 0 -0.03"/>'
SIX = ("yaw", "roll", "pitch", "knee", "pitch", "roll")
PITCH_FIRST = ("pitch", "roll", "yaw", "knee", "pitch", "roll")
HEAD = """
<body name="neck" pos="0 0 0.22"><joint name="head pan" axis="0 0 1" range="-1.5 1.5"/>
<geom type="box" size="0.01 0.01 0.02" mass="0.05"/>
<body name="head" pos="0 0 0.03"><joint name="head.tilt" axis="0 1 0" range="-0.9 1"/>
<geom type="box" size="0.04 0.04 0.04" pos="0 0 0.04" mass="0.3"/>{camera}</body></body>
"""
CAMERA = '<camera name="eye" pos="0.04 0 0.04" xyaxes="0 -1 0 0 0 1"/>'
BACKWARDS = '<camera name="eye" pos="0.04 0 0.04" xyaxes="0 1 0 0 0 1"/>'


def leg(side: str, joints: tuple[str, ...], foot: str, sign: float = 1.0) -> str:
    """A leg of that many links, its knee below a thigh of 12 cm, its ankle below a shank of 12."""
    below = ""
    for number in range(len(joints) - 1, -1, -1):
        kind = joints[number]
        # A knee is a pitch joint; what stands behind it hangs at the end of the shank.
        knee = joints.index("knee") if "knee" in joints else -1
        drop = 0.12 if knee >= 0 and number in (knee, knee + 1) else 0.0
        axis = AXES["pitch" if kind == "knee" else kind]
        bounds = "-0.05 2.3" if kind == "knee" else RANGES[kind]
        name = f"{side}_{number}_{kind}"
        shape = foot if number == len(joints) - 1 else '<geom type="sphere" size="0.02"/>'
        below = (
            f'<body name="{name}_link" pos="0 0 {-drop}">'
            f'<joint name="{name}" axis="{axis}" range="{bounds}" armature="0.005"/>'
            f"{shape}{below}</body>"
        )
    y = 0.05 * (1 if side == "left" else -1) * sign
    return f'<body name="{side}_hip" pos="0 {y} -0.05"><geom size="0.02"/>{below}</body>'


def biped(
    joints: tuple[str, ...] = PITCH_FIRST,
    foot: str = BOX_FOOT,
    head: str = HEAD.format(camera=CAMERA),
    *,
    motors: str = '<motor name="{0}" joint="{0}" ctrlrange="-12 12"/>',
    more: str = "",
    legs: str | None = None,
) -> str:
    """An MJCF: a trunk of 4 kg, two legs, a head; a motor for each hinge of the legs and head."""
    both = legs if legs is not None else leg("left", joints, foot) + leg("right", joints, foot)
    names = [f"{side}_{n}_{k}" for side in ("left", "right") for n, k in enumerate(joints)]
    if "head pan" in head:
        names += ["head pan", "head.tilt"]
    actuators = "".join(motors.format(name) for name in names) if legs is None else ""
    return f"""<mujoco><compiler angle="radian"/><worldbody>
<body name="trunk" pos="0 0 0.4"><freejoint/>
<geom type="box" size="0.05 0.08 0.12" pos="0 0 0.08" mass="4"/>{both}{head}</body></worldbody>
<actuator>{actuators}</actuator>{more}</mujoco>"""


def robot_folder(folder: Path, text: str, name: str = "biped") -> Path:
    """A folder with this MJCF alone."""
    robot = folder / name
    robot.mkdir(parents=True)
    (robot / f"{name}.xml").write_text(text, encoding="utf-8")
    return robot
