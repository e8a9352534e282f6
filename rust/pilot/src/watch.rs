//! What the pilot does about senses that are wrong: the robot comes to stand, whatever it was about to do, and says which it is.

use behaviour::{Behaviour, BehaviourError, Command, Decision, Outcome, Situation};
use sensing::{FrameWatch, SenseFault};

/// The behaviour's decision. Where a sense of the body is wrong: to stand, and to refuse once the robot does; who gives up while
/// its `camera` is wrong gives up because of the camera.
pub(crate) fn decide(
    behaviour: &mut dyn Behaviour,
    situation: &Situation<'_>,
    fault: Option<&SenseFault>,
    frames: &FrameWatch,
) -> Result<Decision, BehaviourError> {
    if let Some(fault) = fault {
        return Ok(stand(fault, situation));
    }
    let mut decision = behaviour.next(situation)?;
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
