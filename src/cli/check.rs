//! `rtc check`: every file is checked, whatever is found in those before.

use super::Failure;
use super::args::CheckArgs;
use super::input::Input;
use super::talk::Talk;

/// Checks the files and tells what was found.
pub(super) fn run(args: &CheckArgs) -> Result<(), Failure> {
    let mut talk = Talk::as_result(&args.talk);
    let mut worst = Ok(());
    for path in &args.files {
        let mut input = Input::read(path, &args.reading);
        input.prove(|_, _| ());
        match input.tell(&mut talk) {
            Err(gone @ Failure::ClosedPipe) => return Err(gone),
            Err(Failure::Findings) if worst.is_err() => {}
            Err(failure) => worst = Err(failure),
            Ok(()) => {}
        }
    }
    talk.finish()?;
    worst
}
