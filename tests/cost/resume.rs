//! An interrupted study resumes from its journal and gives the same errors.

use super::*;
use rtc::internals::study::Journal;

const RAYS: u64 = 300_000;

/// Resumes a study until a number of further rays is traced; returns its journal.
fn go_on(scene: &Scene, kept: &[u8], most: u64) -> (Result<Study, Stopped>, Vec<u8>) {
    let traced = AtomicU64::new(0);
    let clock = || Duration::from_micros(traced.load(Ordering::Relaxed));
    let on_pixel =
        |step: RenderStep| traced.fetch_add(step.rays, Ordering::Relaxed) + step.rays < most;
    let clock = WorkClock {
        cpu: &clock,
        wall: &clock,
    };
    let journal = Journal::new(&StudyProvenance::default(), Effort(RAYS), 1);
    let journal = match kept {
        [] => journal,
        kept => journal.load(kept).unwrap(),
    };
    let saved = Mutex::new(Vec::new());
    let save = |journal: &Journal| *saved.lock().unwrap() = journal.save();
    let runtime = StudyRuntime::new(1, clock, &on_pixel).unwrap();
    let runtime = runtime.with_journal(journal, Duration::from_secs(1), &save);
    let study = study::study(scene, StudyProvenance::default(), Effort(RAYS), 1, &runtime);
    runtime.save();
    drop(runtime);
    (study, saved.into_inner().unwrap())
}

/// Everything that does not depend on a clock.
fn timeless(study: &Study) -> String {
    let mut rows: Vec<String> = study
        .rows
        .iter()
        .map(|row| {
            format!(
                "{:?} {:?} {:?} {:?} {}",
                row.setting, row.errors, row.spread, row.rays, row.model
            )
        })
        .collect();
    rows.sort();
    let precision = study
        .precision
        .iter()
        .map(|cost| (cost.rays, cost.difference));
    let precision: Vec<_> = precision.collect();
    let (reference, parameters) = (study.reference, &study.parameters);
    format!("{rows:?} {precision:?} {reference:?} {parameters:?}")
}

#[test]
fn an_interrupted_study_has_the_same_errors_and_says_which_rows_were_timed_before() {
    let scene = scene(&[]);
    let (whole, _) = go_on(&scene, &[], u64::MAX);
    let whole = whole.unwrap();
    assert!(whole.rows.iter().all(|row| !row.resumed));
    let (mut kept, mut runs) = (Vec::new(), 0);
    let study = loop {
        let (study, renders) = go_on(&scene, &kept, RAYS / 4);
        (kept, runs) = (renders, runs + 1);
        match study {
            Ok(study) => break study,
            Err(Stopped) => assert!(runs < 50, "it gets no further"),
        }
    };
    assert!(runs > 2, "it was interrupted");
    assert_eq!(timeless(&study), timeless(&whole));
    let marked = study.rows.iter().filter(|row| row.resumed).count();
    assert!(marked > 0 && study::table(&study).contains('†'));
    // A finished study renders nothing again: its seconds are the recorded ones.
    let (again, after) = go_on(&scene, &kept, 1);
    let again = again.unwrap();
    assert!(after == kept && again.rows.iter().all(|row| row.resumed));
    let seconds = |study: &Study| study.rows.iter().map(|row| row.seconds).collect::<Vec<_>>();
    assert_eq!(seconds(&again), seconds(&study));
}

#[test]
fn renders_of_another_study_or_damaged_ones_are_refused() {
    let (_, kept) = go_on(&scene(&[]), &[], RAYS / 4);
    let other = |effort, seed| Journal::new(&StudyProvenance::default(), Effort(effort), seed);
    let refused = |journal: Journal, bytes: &[u8]| journal.load(bytes).err().unwrap();
    assert_eq!(
        refused(other(RAYS, 2), &kept),
        "it belongs to another study: seed: 1 here, 2 there"
    );
    assert!(refused(other(7, 1), &kept).contains("effort: 300000 here, 7 there"));
    let short = &kept[..kept.len() - 1];
    assert!(refused(other(RAYS, 1), short).contains("checksum"));
    assert!(refused(other(RAYS, 1), b"something else").contains("no renders"));
    assert!(other(RAYS, 1).load(&kept).unwrap().len() > 1);
}
