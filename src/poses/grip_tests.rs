//! Proves grips by size in pose files and sequences, and what a grip is told by there.

use crate::hand::gap::{Gap, gap_on_path};
use crate::hand::grip::{GripEstimate, GripState, GripThreshold};
use crate::hand::{Angle, Dof, Moment, PerDof, Speed};
use crate::poses::edit::{PoseEdit, SequenceEdit};
use crate::poses::file::{read, write};
use crate::poses::library::{EntryId, PoseLibrary, StepGoal};
use crate::poses::player::{PlayMode, PlayPhase, Player};
use crate::poses::preview::Preview;
use crate::poses::way::WayPart;

const GOOD: &str = r#"format = "handscope-poses"
version = 1

[[pose]]
name = "Block"
tags = []
speed = 300
force = 800
leave = ["little"]
grip = { kind = "pinch", gap_mm = 12.5 }
grip_thresholds = { contact_n = 0.1, least_fingers = 2 }

[[sequence]]
name = "Take"
loop = false
[[sequence.step]]
grip = { kind = "pinch", gap_mm = 30 }
speed = 200
force = 400
dwell_ms = 100
limit_ms = 9000
until = { grip = "holding", within_ms = 3000, retries = 1 }
[[sequence.step]]
pose = "Block"
speed = 250
dwell_ms = 0
limit_ms = 3000
"#;

/// A file as it was written before there were grips by size.
const OLD: &str = r#"format = "handscope-poses"
version = 1

[[pose]]
name = "A"
tags = []
speed = 300
force = 800
leave = ["little"]

[pose.angles]
little = 1000
ring = 1000
middle = 1000
index = 420
thumb_bend = 420
thumb_rotate = 200

[[sequence]]
name = "Wave"
loop = true

[[sequence.step]]
pose = "A"
speed = 250
dwell_ms = 400
limit_ms = 3000

[sequence.step.until]
grip = "holding"
within_ms = 2000
retries = 3
"#;

fn gap(mm: f32) -> Gap {
    Gap::new(mm).unwrap()
}

#[test]
fn a_file_without_grips_is_written_as_it_was() {
    assert_eq!(write(&read(OLD).unwrap()).unwrap(), OLD);
}

#[test]
fn a_grip_by_size_is_read_as_documented_and_comes_back() {
    let library = read(GOOD).unwrap();
    let pose = &library.poses[0];
    assert_eq!(
        (pose.gap, pose.angles),
        (Some(gap(12.5)), gap(12.5).angles())
    );
    assert_eq!(pose.targets()[Dof::Little], None);
    let thresholds = pose.thresholds.unwrap();
    assert_eq!(GripThreshold::ContactTip.of(&thresholds), 0.1);
    assert_eq!(thresholds.least_fingers, 2);
    let [first, second] = library.sequences[0].steps.as_slice() else {
        panic!("{library:?}");
    };
    let force = crate::hand::Force::nearest(400);
    let goal = StepGoal::Gap {
        gap: gap(30.0),
        force,
    };
    assert_eq!((first.goal, second.goal), (goal, StepGoal::Pose(pose.id)));
    let again = write(&library).unwrap();
    assert_eq!(read(&again).unwrap(), library);
    for kept in ["gap_mm = 12.5", "contact_n = 0.1", "least_fingers = 2"] {
        assert!(again.contains(kept), "{again}");
    }
    assert!(
        !again.contains("angles") && !again.contains("open_from"),
        "{again}"
    );
}

#[test]
fn what_is_wrong_with_a_grip_is_said_with_line_reason_and_what_to_do() {
    for (from, to, said) in [
        (
            "gap_mm = 12.5",
            "gap_mm = 2.9",
            "line 10, `gap_mm`: 2.9 mm is outside 3 to 120 mm",
        ),
        (
            "gap_mm = 30",
            "gap_mm = 121",
            "line 17, `gap_mm`: 121 mm is outside 3 to 120 mm",
        ),
        (
            "gap_mm = 30",
            "gap_mm = nan",
            "line 17, `gap_mm`: NaN mm is outside 3 to 120 mm",
        ),
        (
            "gap_mm = 30",
            "gap_mm = \"3\"",
            "line 17, `gap_mm`: \"3\" is not a number",
        ),
        (
            "pinch\", gap_mm = 30",
            "around\", gap_mm = 30",
            "line 17, `kind`: a grip around something has no gap: the fingers close on the palm",
        ),
        (
            "pinch\", gap_mm = 12",
            "three-fingers\", gap_mm = 12",
            "line 10, `kind`: a grip of three fingers has no gap",
        ),
        (
            "pinch\", gap_mm = 30",
            "claw\", gap_mm = 30",
            "line 17, `kind`: \"claw\" is unknown here, known: pinch, three-fingers",
        ),
        (
            "gap_mm = 30",
            "gap = 30",
            "line 17, `gap`: unknown key, known here: kind, gap_mm",
        ),
        (
            "force = 400\n",
            "",
            "line 16, `force`: it is missing: add it",
        ),
        (
            "grip = { kind = \"pinch\", gap_mm = 30 }\n",
            "",
            "line 16, `pose`: it is missing",
        ),
        (
            "pose = \"Block\"",
            "pose = \"Block\"\nforce = 3",
            "line 23, `force`: it conflicts with `pose`: remove one",
        ),
        (
            "pose = \"Block\"",
            "pose = \"Block\"\ngrip = { kind = \"pinch\", gap_mm = 9 }",
            "line 23, `grip`: it conflicts with `pose`",
        ),
        (
            "[\"little\"]",
            "[\"index\"]",
            "line 9, `leave`: a grip by size needs index: remove it here",
        ),
        (
            "grip = { kind = \"pinch\", gap_mm = 12.5 }\n",
            "",
            "`angles`: it is missing: add it",
        ),
        (
            "contact_n = 0.1",
            "contact_n = 0.01",
            "line 11, `contact_n`: 0.01 is outside 0.05 to 20",
        ),
        (
            "contact_n = 0.1",
            "contact = 1",
            "line 11, `contact`: unknown key, known here:",
        ),
        (
            "fingers = 2",
            "fingers = 2.5",
            "line 11, `least_fingers`: 2.5 is outside 1 to 5",
        ),
        (
            "fingers = 2",
            "fingers = \"2\"",
            "line 11, `least_fingers`: \"2\" is outside 1 to 5",
        ),
    ] {
        let bad = GOOD.replacen(from, to, 1);
        assert_ne!(bad, GOOD, "{from}");
        let error = read(&bad).unwrap_err().to_string();
        assert!(error.contains(said), "{to}: {error}");
    }
}

fn grasp(state: GripState) -> GripEstimate {
    let since = Moment::from_micros(1);
    GripEstimate {
        state,
        since,
        asked: Some(since),
    }
}

/// A hand that goes where it is sent, and stops where an object of this gap is.
struct Hand {
    angles: PerDof<i16>,
    object: Option<Gap>,
}

impl Hand {
    fn follow(&mut self, part: &WayPart) {
        for (dof, to) in part.targets.iter() {
            let stop = self.object.map_or(0, |gap| gap.angles()[dof].get());
            let stop = if Gap::JOINTS.contains(&dof) { stop } else { 0 };
            if let Some(to) = to {
                self.angles[dof] = to.get().max(stop);
            }
        }
    }

    fn seen(&self) -> PerDof<Option<i16>> {
        self.angles.map(Some)
    }
}

fn playing(library: &PoseLibrary, entry: EntryId) -> Player {
    let cues = library.plan(entry).unwrap().cues;
    Player::start(cues, false, PlayMode::Through, Moment::ZERO)
}

#[test]
fn a_grip_by_size_opens_first_and_closes_along_the_path_each_joint_at_its_speed() {
    let library = read(GOOD).unwrap();
    let mut player = playing(&library, EntryId::Pose(library.poses[0].id));
    let mut hand = Hand {
        angles: PerDof::splat(200),
        object: None,
    };
    let mut sent = Vec::new();
    for ms in (0..20_000).step_by(100) {
        let now = Moment::from_micros(ms * 1000);
        if let Some(part) = player.tick(now, &hand.seen(), &grasp(GripState::Moving)) {
            hand.follow(&part);
            sent.push(part);
        }
    }
    let (opens, closes): (Vec<WayPart>, Vec<WayPart>) =
        sent.into_iter().partition(|part| !part.is_pinching);
    assert_eq!(opens[0].targets[Dof::ThumbBend], Some(Angle::MAX));
    assert_eq!(
        opens[0].targets[Dof::Index],
        None,
        "the thumb goes out of the way first"
    );
    assert_eq!(closes.len(), 2, "by the corner of the path");
    let last = closes[1];
    assert_eq!(
        last.targets[Dof::Index],
        Some(gap(12.5).angles()[Dof::Index])
    );
    assert_eq!(last.targets[Dof::Little], None, "left alone");
    assert_eq!(last.speeds[Dof::ThumbBend], Speed::nearest(300));
    assert!(
        last.speeds[Dof::Index] < Speed::nearest(200),
        "they arrive together"
    );
    let end = gap_on_path(&hand.angles.map(f32::from)).unwrap();
    assert!((end - 12.5).abs() < 0.2, "{end}");
    assert!(player.is_over());
}

#[test]
fn a_step_by_size_ends_with_what_it_holds_on_any_part_of_the_path() {
    let library = read(GOOD).unwrap();
    for mm in [110.0, 50.0] {
        let mut player = playing(&library, EntryId::Sequence(library.sequences[0].id));
        let mut hand = Hand {
            angles: Gap::MAX.angles().map(Angle::get),
            object: Some(gap(mm)),
        };
        let mut ms = 0;
        while player.view().at == 0 && !matches!(player.view().phase, PlayPhase::Dwelling { .. }) {
            ms += 100;
            assert!(ms < 5000, "{mm}: {:?}", player.view());
            let now = Moment::from_micros(ms * 1000);
            let held = GripEstimate {
                since: Moment::from_micros(500_000),
                ..grasp(if ms < 500 {
                    GripState::Moving
                } else {
                    GripState::Holding
                })
            };
            if let Some(part) = player.tick(now, &hand.seen(), &held) {
                hand.follow(&part);
            }
        }
        assert_eq!(player.view().late, 0, "{mm}");
    }
}

#[test]
fn a_step_by_size_that_is_empty_opens_along_the_path_to_try_again() {
    let library = read(GOOD).unwrap();
    let mut player = playing(&library, EntryId::Sequence(library.sequences[0].id));
    let mut hand = Hand {
        angles: Gap::MAX.angles().map(Angle::get),
        object: None,
    };
    let mut widest = Vec::new();
    for ms in (0..3000).step_by(100) {
        let now = Moment::from_micros(ms * 1000);
        if let Some(part) = player.tick(now, &hand.seen(), &grasp(GripState::Empty)) {
            assert!(part.is_pinching, "on the path all the time");
            hand.follow(&part);
            widest.push(gap_on_path(&hand.angles.map(f32::from)).unwrap().round());
        }
    }
    assert_eq!(widest, [90.0, 30.0, 90.0, 120.0, 90.0, 30.0]);
}

#[test]
fn a_dry_run_shows_the_grip_at_its_gap() {
    let library = read(GOOD).unwrap();
    let own = library.sequences[0].id;
    let from = PerDof::splat(Some(200));
    let preview = Preview::of(&library, own, from, Moment::ZERO).unwrap();
    let shown = preview.at(Moment::from_micros(60_000_000));
    let counts = shown.shares.map(|share| share.unwrap() * 1000.0);
    assert!((gap_on_path(&counts).unwrap() - 12.5).abs() < 0.2);
}

#[test]
fn a_pose_by_size_is_edited_by_its_gap_and_its_angles_follow() {
    let mut library = read(GOOD).unwrap();
    let id = library.poses[0].id;
    let edited = |library: &mut PoseLibrary, edit| {
        library.edit_pose(id, edit);
        library.poses[0].clone()
    };
    let fixed = edited(&mut library, PoseEdit::Angle(Dof::Index, Angle::MIN));
    assert_eq!(fixed.angles, gap(12.5).angles());
    let whole = edited(&mut library, PoseEdit::Leave(Dof::ThumbBend, true));
    assert!(!whole.leave[Dof::ThumbBend] && whole.leave[Dof::Little]);
    let other = edited(&mut library, PoseEdit::Gap(Some(gap(40.0))));
    assert_eq!(
        (other.gap, other.angles),
        (Some(gap(40.0)), gap(40.0).angles())
    );
    let plain = edited(&mut library, PoseEdit::Gap(None));
    assert_eq!((plain.gap, plain.angles), (None, gap(40.0).angles()));
    edited(&mut library, PoseEdit::Leave(Dof::Index, true));
    assert!(!edited(&mut library, PoseEdit::Gap(Some(gap(50.0)))).leave[Dof::Index]);
    let own = library.sequences[0].id;
    library.edit_sequence(own, SequenceEdit::AddGap(gap(20.0)));
    library.edit_pose(id, PoseEdit::Delete);
    let goals = library.sequences[0].steps.iter().map(|step| step.goal);
    let gaps: Vec<_> = goals
        .map(|goal| match goal {
            StepGoal::Gap { gap, .. } => gap.mm(),
            StepGoal::Pose(_) | StepGoal::Hold(_) => f32::NAN,
        })
        .collect();
    assert_eq!(gaps, [30.0, 20.0], "grips by size need no pose");
    let mut other = PoseLibrary::default();
    other.merge(library.clone());
    assert_eq!(other.sequences[0].steps.len(), 2);
}
