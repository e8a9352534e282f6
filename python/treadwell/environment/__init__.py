"""The courses as Gymnasium environments; needs the extra `gym`. Importing it registers the ids.

`treadwell/ObstacleCourse-v0` takes any scenario by `scenario=...`. Each scenario that ships with
the package has an id too, as in `treadwell/StairsUp-v0`. With `Footsteps` before the `-v0` actions
are footsteps instead of velocities.
"""

try:
    from gymnasium.envs.registration import register, registry
except ImportError as error:
    from treadwell.extras import install_hint

    raise ImportError(f"needs gymnasium: {install_hint('gym')}") from error

from treadwell.scenario.loading import scenario_names

ENTRY = "treadwell.environment.course_env:CourseEnv"


def environment_id(scenario: str, suffix: str = "") -> str:
    """Return the id of a scenario's environment, as in `treadwell/StairsUp-v0`."""
    return f"treadwell/{''.join(word.title() for word in scenario.split('_'))}{suffix}-v0"


def register_all() -> None:
    """Register every scenario that ships with the package, unless that was done."""
    for scenario in scenario_names():
        for actions, suffix in (("velocity", ""), ("footsteps", "Footsteps")):
            name = environment_id(scenario, suffix)
            if name not in registry:
                register(name, ENTRY, kwargs={"scenario": scenario, "actions": actions})


register_all()
