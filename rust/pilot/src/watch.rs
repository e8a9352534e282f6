//! What the pilot does about senses that are wrong, about what comes towards the robot, and about footsteps that its walker does not
//! take: it comes to stand, whatever it was about to do.

use behaviour::{Behaviour, BehaviourError, Command, Decision, Motion, Outcome, Situation};
use sensing::{FrameWatch, SenseFault};

/// Why the robot refuses whose walker is to take footsteps and takes none.
const NO_FOOTSTEPS: &str =
    "walker: the way needs footsteps one by one, and this walker takes velocities alone";

/// The behaviour's decision. Where a sense of the body is wrong: to stand, and to refuse once the robot does; who gives up while
/// its `camera` is wrong gives up because of the camera. Who walks stands while something `comes`. Who lists footsteps for a walker that
/// takes none stands and refuses.
pub(crate) fn decide(
    behaviour: &mut dyn Behaviour,
    situation: &Situation<'_>,
    (fault, comes): (Option<&SenseFault>, bool),
    frames: &FrameWatch,
) -> Result<Decision, BehaviourError> {
    if let Some(fault) = fault {
        return Ok(stand(fault.to_string(), situation));
    }
    let mut decision = behaviour.next(situation)?;
    if matches!(decision.command.motion, Motion::Footsteps(_)) && !situation.takes_footsteps {
        return Ok(stand(NO_FOOTSTEPS.to_owned(), situation));
    }
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

fn stand(reason: String, situation: &Situation<'_>) -> Decision {
    let refused = Outcome::Refused(reason);
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
