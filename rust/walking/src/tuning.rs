//! The finer settings of the gait: `[gait.tuning]` of robot.toml.

mod legs;
mod pushes;

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, above_to, at_least, settings, within};

pub(crate) use legs::{LegTuning, SharedHipTuning, SoleFitTuning};
pub(crate) use pushes::{BucklingTuning, CaptureTuning, CatchingTuning, TippingTuning};

/// Most steps that may be looked ahead: room for them in an array.
pub(crate) const MOST_STEPS: usize = 8;

settings! {
    /// The finer settings of the gait.
    pub struct GaitTuning("gait.tuning") {
        /// How the walker keeps time, and what it takes for a load.
        ticks: TicksTuning;
        /// The inverse kinematics of the legs.
        leg: LegTuning;
        /// How two hips agree that share one yaw motor.
        shared_hip: SharedHipTuning;
        /// What narrow soles change of the gait.
        sole_fit: SoleFitTuning;
        /// How the motion of the centre of mass is measured.
        balance: BalanceTuning;
        /// How the torso turns, and the swing foot with its tilt.
        posture: PostureTuning;
        /// The height of the hips.
        pelvis: PelvisTuning;
        /// How the torso leans forward on high steps.
        lean: LeanTuning;
        /// How the weight goes ahead on steps down.
        descent: DescentTuning;
        /// How a heel lifts.
        heel: HeelTuning;
        /// Where a sole carries, and when feet stand side by side.
        stance: StanceTuning;
        /// How far the steps are looked ahead.
        preview: PreviewTuning;
        /// How steps are moved to catch a push.
        capture: CaptureTuning;
        /// Steps that catch a push which ankles cannot hold.
        catching: CatchingTuning;
        /// How an ankle yields.
        ankles: AnklesTuning;
        /// The path of the swing foot.
        swing: SwingTuning;
        /// How a foot of a walk lands, and what it takes for a level that it was not told of.
        stumble: StumbleTuning;
        /// Which steps of a list are walked.
        listed: ListedTuning;
        /// How a foot of a listed step lands.
        landing: LandingTuning;
        /// When a leg buckles under a listed step.
        buckling: BucklingTuning;
        /// When a listed step is begun anew because the robot tips.
        tipping: TippingTuning;
        /// How slopes are asked for.
        relief: ReliefTuning;
    }
}

settings! {
    /// How the walker keeps time, and what it takes for a load.
    pub struct TicksTuning("gait.tuning.ticks") {
        /// A shorter time since the last tick than this share of the control tick counts as so long.
        shortest: f64 = 0.1, "1", above_to(0.0, 1.0);
        /// A longer time since the last tick than so many control ticks counts as so long.
        longest: f64 = 2.0, "1", at_least(1.0);
        /// Load on both feet together below which each is trusted alike.
        least_load: f64 = 1.0, "N", POSITIVE;
        /// Share of the robot's weight that the feet must carry for their centre of pressure to count.
        pressure_load: f64 = 0.3, "1", SHARE;
    }
}

settings! {
    /// How the motion of the centre of mass is measured.
    pub struct BalanceTuning("gait.tuning.balance") {
        /// Share of the turn of a foot that lands turned which is taken out of the speed of the centre of mass; where soles are narrower
        /// than the robot is large and this is not given, all of it.
        turned: f64 = 0.0, "1", SHARE;
    }
}

settings! {
    /// How the torso turns, and the swing foot with its tilt.
    pub struct PostureTuning("gait.tuning.posture") {
        /// How fast the torso turns to the mean heading of the feet.
        turn_rate: f64 = 8.0, "1/s", within(0.0, 100.0);
        /// How fast the correction of the swing foot for the tilt comes and goes.
        tilt_fade: f64 = 6.0, "1/s", within(0.0, 100.0);
        /// Tilt of the torso that is not worth a correction of the swing foot.
        tilt_deadband: f64 = 0.02, "rad", within(0.0, 3.2);
    }
}

settings! {
    /// The height of the hips: the coming steps are played ahead, so that the hips are down when a foot has to reach down.
    pub struct PelvisTuning("gait.tuning.pelvis") {
        /// How many moments ahead are looked at.
        moments: usize = 24, "1", within(1.0, 1000.0);
        /// Time from one of those moments to the next.
        apart: f64 = 0.04, "s", above_to(0.0, 60.0);
        /// Time constant of the smoothing of the height.
        smooth_time: f64 = 0.06, "s", above_to(0.0, 60.0);
        /// Time constants by which the smoothed height is taken to be late.
        late: f64 = 2.5, "1", NOT_NEGATIVE;
        /// How much faster than up the height to come to goes down.
        fall: f64 = 2.0, "1", POSITIVE;
    }
}

settings! {
    /// How the torso leans forward on a step up that is higher than the ankle: the shank is to clear the step behind it.
    pub struct LeanTuning("gait.tuning.lean") {
        /// The edge of the step behind is taken to be so far ahead of the toes.
        edge_ahead: f64 = 0.01, "m", within(0.0, 10.0);
        /// Least distance of the shank's middle line from that edge.
        clearance: f64 = 0.022, "m", within(0.0, 10.0);
        /// Fastest that the torso leans.
        speed: f64 = 0.8, "rad/s", above_to(0.0, 100.0);
        /// Time constant of the smoothing of the lean.
        smooth_time: f64 = 0.06, "s", above_to(0.0, 60.0);
        /// A torso that is to be upright and leans by less is.
        upright: f64 = 1e-4, "rad", above_to(0.0, 1.0);
        /// How often the range in which the lean is sought is halved.
        halvings: usize = 7, "1", within(1.0, 60.0);
    }
}

settings! {
    /// How far the weight goes forward over the foot that stands while the other one is put down on a lower level, where the ankle of that
    /// one would come to its end.
    pub struct DescentTuning("gait.tuning.descent") {
        /// Share of the peak torque of the ankle that stands which that may take.
        torque: f64 = 0.5, "1", SHARE;
        /// How long the leg that goes down is taken to be, as a share of the longest.
        stretched: f64 = 0.999, "1", above_to(0.0, 1.0);
        /// How often the range in which the reach of that leg is sought is halved.
        halvings: usize = 12, "1", within(1.0, 60.0);
    }
}

settings! {
    /// How the heel of a foot lifts that is left behind on the upper of two levels: its ankle bends no further.
    pub struct HeelTuning("gait.tuning.heel") {
        /// How often the angle is sought that the ankle asks for.
        times: usize = 5, "1", within(0.0, 60.0);
        /// A smaller angle is not worth another time.
        least: f64 = 5e-4, "rad", above_to(0.0, 1.0);
        /// The heel lifts by no more than this.
        most: f64 = 0.6, "rad", within(0.0, 1.5);
    }
}

settings! {
    /// Where a sole carries, and when feet stand side by side.
    pub struct StanceTuning("gait.tuning.stance") {
        /// Share of what bears, from its middle to each end, in which the point where the foot carries lies.
        support_room: f64 = 0.5, "1", SHARE;
        /// Feet are side by side when they are nearer than this to where they are to stand.
        beside: f64 = 0.01, "m", above_to(0.0, 10.0);
        /// Feet are side by side when their headings differ by less than this.
        beside_turn: f64 = 0.03, "rad", above_to(0.0, 3.2);
        /// A walk that turns begins with the foot on that side, as one that goes aside does: a turn by 1 rad counts as so much.
        turn_counts: f64 = 0.1, "m/rad", NOT_NEGATIVE;
    }
}

settings! {
    /// How far the steps are looked ahead.
    pub struct PreviewTuning("gait.tuning.preview") {
        /// Steps that are looked ahead, the running one included: what lies beyond hardly counts.
        steps: usize = 3, "1", within(1.0, MOST_STEPS as f64);
    }
}

settings! {
    /// How an ankle yields.
    pub struct AnklesTuning("gait.tuning.ankles") {
        /// Time over which the measured forces are smoothed.
        smooth_time: f64 = 0.02, "s", above_to(0.0, 60.0);
        /// How fast a foot in the air gets level again.
        level_rate: f64 = 10.0, "1/s", within(0.0, 100.0);
    }
}

settings! {
    /// The path of the swing foot: from when to when it moves, as shares of its time in the air.
    pub struct SwingTuning("gait.tuning.swing") {
        /// When a foot of a walk moves over the ground.
        travel: [f64; 2] = [0.1, 0.9], "1", SHARE;
        /// When a foot that goes back off something it met moves over the ground.
        off: [f64; 2] = [0.0, 0.7], "1", SHARE;
        /// When a foot that goes back off something it met sinks.
        down: [f64; 2] = [0.4, 1.0], "1", SHARE;
        /// When a careful foot rises.
        rise: [f64; 2] = [0.0, 0.38], "1", SHARE;
        /// When a careful foot moves over the ground; after that it comes down on what it is told to land on.
        over: [f64; 2] = [0.25, 0.75], "1", SHARE;
        /// When a careful foot sinks.
        sink: [f64; 2] = [0.62, 1.0], "1", SHARE;
    }
    require (travel[0]) < (travel[1]);
    require (off[0]) < (off[1]);
    require (down[0]) < (down[1]);
    require (rise[0]) < (rise[1]);
    require (over[0]) < (over[1]);
    require (sink[0]) < (sink[1]);
}

settings! {
    /// How a foot of a walk lands, and what it takes for a level that it was not told of.
    pub struct StumbleTuning("gait.tuning.stumble") {
        /// Share of the swing after which a load on the foot is a landing.
        landing_share: f64 = 0.6, "1", SHARE;
        /// A foot that touched early, is held higher than this for it, and carries nothing as both are to goes down again: it has only
        /// touched. Where soles are narrower than the robot is large and this is not given, at any height.
        hangs: f64 = 0.02, "m", within(0.0, 10.0);
        /// How far off the edge that it met a foot goes back.
        clear: f64 = 0.025, "m", within(0.0, 10.0);
        /// A foot of which more than this share lies beyond the edge that it met stands well there: pressed at its
        /// middle it may as well lie on a cable.
        stands_share: f64 = 1.0, "1", SHARE;
    }
}

settings! {
    /// Which steps of a list are walked that are to be, and how much they may be moved.
    pub struct ListedTuning("gait.tuning.listed") {
        /// A step that leads higher or lower than this from where the foot leaves, or from the foot that stands, is taken carefully: floors
        /// differ by so much.
        level: f64 = 0.01, "m", within(0.0, 10.0);
        /// A step is shortened by so much to what the robot walks; one that would have to be shortened more is taken carefully.
        shortened: f64 = 0.01, "m", within(0.0, 10.0);
        /// The farthest that a walked step is moved to catch a push: beside where it was told there may be an edge.
        moved: f64 = 0.0, "m", within(0.0, 10.0);
        /// Time from its lift in which a careful foot that stood higher or lower than told behind a walked step goes to its path.
        level_time: f64 = 0.1, "s", above_to(0.0, 60.0);
    }
}

settings! {
    /// How a foot of a listed step lands.
    pub struct LandingTuning("gait.tuning.landing") {
        /// Share of the time after which a foot has left the ground for sure.
        left_share: f64 = 0.25, "1", SHARE;
        /// How far a foot may be behind its path.
        lag: f64 = 0.02, "s", within(0.0, 60.0);
        /// How short a leg may be while its foot is still sent further down: the hips come down more slowly than a foot.
        short: f64 = 0.001, "m", within(0.0, 10.0);
        /// After this time in which the leg stays that short there is no ground within its reach.
        short_time: f64 = 1.5, "s", within(0.0, 60.0);
        /// How far before what it met a foot then comes down.
        clear: f64 = 0.003, "m", above_to(0.0, 10.0);
    }
}

settings! {
    /// How slopes are asked for.
    pub struct ReliefTuning("gait.tuning.relief") {
        /// Places along a sole, and along the way from one foot to the other, at which the slope is asked for.
        places: usize = 6, "1", within(1.0, 1000.0);
        /// The map is looked at so far around the robot: farther than it steps.
        around: f64 = 0.3, "m", above_to(0.0, 10.0);
    }
}
