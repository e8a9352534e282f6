//! What the pilot does about senses that are wrong, and about what comes towards the robot: it comes to stand, whatever it was about to do.

use behaviour::{Behaviour, BehaviourError, Command, Decision, Motion, Outcome, Situation};
use sensing::{FrameWatch, SenseFault};

/// The behaviour's decision. Where a sense of the body is wrong: to stand, and to refuse once the robot does; who gives up while
/// its `camera` is wrong gives up because of the camera. Who walks stands while something `comes`.
pub(crate) fn decide(
    behaviour: &mut dyn Behaviour,
    situation: &Situation<'_>,
    (fault, comes): (Option<&SenseFault>, bool),
    frames: &FrameWatch,
) -> Result<Decision, BehaviourError> {
    if let Some(fault) = fault {
        return Ok(stand(fault, situation));
    }
    let mut decision = behaviour.next(situation)?;
    if comes && matches!(decision.command.motion, Motion::Walk(_)) {
        decision.command.motion = Motion::Stand;
        decision.state = "stop";
    }
    if let Some(Outcome::Refused(reason)) = &mut decision.outcome
        && let Some(camera) = frames.fault(situation.time_ns)
    {
        *reason = camera.to_string();
    }
    Ok(decision)
}

fn stand(fault: &SenseFault, situation: &Situation<'_>) -> Decision {
    let refused = Outcome::Refused(fault.to_string());
    Decision {
        command: Command {
            gaze: situation.gaze,
            ..Command::default()
        },
        state: "refuse",
        goal_passed: false,
        outcome: situation.standing.then_some(refused),
    }
}
