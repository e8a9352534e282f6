//! What the pilot does about senses that are wrong, about what comes towards the robot, and about footsteps that its walker does not
//! take: it comes to stand, whatever it was about to do.

use behaviour::{
    Behaviour, BehaviourError, Command, Decision, GivingWay, Motion, Mover, Outcome, Situation,
};
use localization::Localizer;
use proprioception::{BodyState, SenseWatch};
use sensing::{FrameWatch, Observation, SenseFault};

use crate::perception::Perception;

/// Why the robot refuses whose walker is to take footsteps and takes none.
const NO_FOOTSTEPS: &str =
    "walker: the way needs footsteps one by one, and this walker takes velocities alone";

/// What is wrong with the senses: by what the body tells, else by what was seen until now.
pub(crate) fn fault(
    (senses, measured, state): (&mut SenseWatch, &Observation, &BodyState),
    (perception, localizer): (&Perception, &dyn Localizer),
) -> Option<SenseFault> {
    (senses.look(measured, state))
        .or_else(|| perception.fault(localizer))
        .cloned()
}

/// The behaviour's decision. Where a sense of the body is wrong: to stand, and to refuse once the robot does; who gives up while
/// its `camera` is wrong gives up because of the camera. What comes is given way. Who lists footsteps for a walker that takes none stands
/// and refuses.
pub(crate) fn decide(
    behaviour: &mut dyn Behaviour,
    giving_way: &mut GivingWay,
    situation: &Situation<'_>,
    (fault, movers, eye_m): (Option<&SenseFault>, &[Mover], f64),
    frames: &FrameWatch,
) -> Result<Decision, BehaviourError> {
    if let Some(fault) = fault {
        return Ok(stand(fault.to_string(), situation));
    }
    let mut decision = behaviour.next(situation)?;
    if matches!(decision.command.motion, Motion::Footsteps(_)) && !situation.takes_footsteps {
        return Ok(stand(NO_FOOTSTEPS.to_owned(), situation));
    }
    giving_way.change(&mut decision, situation, (movers, eye_m));
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
