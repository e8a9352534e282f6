"""Claims about joints without a motor: what moves them is found, by gears and by rods."""

import mujoco
import pytest

from treadwell.robot.loops import drivers, ties_of

PARALLEL = """<mujoco><compiler angle="radian"/><worldbody><body name="base"><freejoint/>
<geom size=".1"/>
<body name="crank" pos="0 0 .2"><joint name="crank" axis="0 1 0" range="-1 1"/>
<geom size=".01" mass=".1"/>
<body name="rod" pos=".05 0 0"><joint name="rod" axis="0 1 0"/><geom size=".01" mass=".01"/>
<site name="end" pos="0 0 .2"/></body></body>
<body name="head" pos="0 0 .4"><joint name="head" axis="0 1 0" range="-1 1"/>
<geom size=".05" mass=".3"/><site name="hold" pos="{hold} 0 0"/></body>
</body></worldbody>
<actuator><motor name="m" joint="crank"/></actuator>
<equality><connect site1="end" site2="hold"/></equality></mujoco>"""


def ties(text: str) -> dict[str, tuple[str, float, float, bool]]:
    model = mujoco.MjModel.from_xml_string(text)
    return {
        model.joint(joint).name: (model.joint(tie.leader).name, tie.ratio, tie.offset, tie.loop)
        for joint, tie in ties_of(model).items()
    }


def test_a_parallelogram_of_rods_is_a_tie_of_ratio_one() -> None:
    found = ties(PARALLEL.format(hold=0.05))
    assert found["head"][0] == "crank"
    assert found["head"][1:3] == pytest.approx((1.0, 0.0), abs=1e-4)
    assert found["rod"][1] == pytest.approx(-1.0, abs=1e-4)
    assert found["head"][3]


def test_rods_that_move_a_joint_along_no_line_are_left_as_they_are() -> None:
    assert ties(PARALLEL.format(hold=0.08)) == {}


@pytest.mark.parametrize(
    ("equalities", "expected"),
    [
        ('<joint joint1="b" joint2="a" polycoef="0.1 -0.5 0 0 0"/>', {"b": (-0.5, 0.1)}),
        ('<joint joint1="a" joint2="b" polycoef="0.1 -0.5 0 0 0"/>', {"b": (-2.0, 0.2)}),
        (
            '<joint joint1="b" joint2="a" polycoef="0 2 0 0 0"/>'
            '<joint joint1="c" joint2="b" polycoef="0.1 3 0 0 0"/>',
            {"b": (2.0, 0.0), "c": (6.0, 0.1)},
        ),
        ('<joint joint1="b" joint2="a" polycoef="0 1 1 0 0"/>', {}),
        ('<joint joint1="b" joint2="c"/>', {}),
    ],
)
def test_gears_are_turned_round_and_shortened_to_the_motor(
    equalities: str, expected: dict[str, tuple[float, float]]
) -> None:
    joints = "".join(
        f'<body><joint name="{name}" axis="0 1 0"/><geom size=".1"/></body>' for name in "abc"
    )
    text = (
        f"<mujoco><worldbody><body><freejoint/><geom size='.1'/>{joints}</body></worldbody>"
        f"<actuator><motor joint='a'/></actuator><equality>{equalities}</equality></mujoco>"
    )
    found = {name: tie[1:3] for name, tie in ties(text).items()}
    assert found.keys() == expected.keys()
    for name, tie in expected.items():
        assert found[name] == pytest.approx(tie)


def test_where_no_joint_has_a_motor_all_could_have_one_but_what_is_tied() -> None:
    text = PARALLEL.format(hold=0.05).replace('<motor name="m" joint="crank"/>', "")
    model = mujoco.MjModel.from_xml_string(text)
    assert drivers(model) == {model.joint(name).id for name in ("crank", "rod", "head")}
