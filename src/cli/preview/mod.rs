//! `rtc preview`: a local web page that shows a scene while it is edited.
//!
//! - `session` runs on the main thread: it reads the scene (`scene`), renders it (`coarse` first),
//!   and publishes the result with the diagnostics (`findings`). `against` renders the reference,
//!   `reports`, `costs` and `pixels` compute reports.
//! - `preview_state` is the state that all threads share: the published picture under a version,
//!   and the requests of the page. `events` streams the state to the page.
//! - `serve` accepts connections of the loopback interface, `http` parses requests, `routes`
//!   answers them.
//! - `watch` polls the files of the scene and requests a new reading.
//! - `view` and `choice` are the view and the settings that the page overrides; `command` writes
//!   them as a command line of `rtc render`.
//!
//! The finished picture has the bytes of `rtc render` with the same options. A request needs the
//! token of the printed address.

mod against;
mod choice;
mod coarse;
mod command;
mod costs;
mod events;
mod findings;
mod http;
mod pixels;
mod preview_state;
mod renderings;
mod reports;
mod routes;
mod scene;
mod serve;
mod session;
mod view;
mod watch;

use super::interrupt::{self, Interrupt};
use super::project::Project;
use super::{Failure, args, input, output, render, reporter};
use against::ComparisonReference;
use command::RenderCommand;
use preview_state::PreviewState;
use routes::Routes;
use serve::AuthGuard;
use session::PreviewSession;
use std::ffi::OsString;
use std::sync::{Arc, Mutex};
use std::thread;
use watch::WatchedFiles;

/// Shows the scene until the program is stopped.
pub(super) fn run(args: &args::PreviewArgs, typed: &[OsString]) -> Result<(), Failure> {
    if args.file.as_os_str() == "-" {
        let message = "standard input can be read only once, so it has no preview; give a file";
        return Err(Failure::Failed(message.to_owned()));
    }
    // A mistyped name; a file that is lost later is reported on the page.
    if !args.file.is_file() {
        let message = format!("there is no file `{}`", args.file.display());
        return Err(Failure::Failed(message));
    }
    // Prepare the session and the reference.
    Interrupt::listen()?;
    let against = ComparisonReference::new(args)?;
    let (preview_state, watched) = (
        Arc::new(PreviewState::default()),
        Arc::new(WatchedFiles::default()),
    );
    let shown = (Arc::clone(&preview_state), Arc::clone(&watched));
    let session = PreviewSession::new(args, RenderCommand::new(typed), shown, against)?;
    // Open the port and its access token.
    let (listener, port) = serve::bind(args.port)?;
    let auth_guard = AuthGuard::new(port)?;
    let project = Project::of(&args.file, &args.reading)?;
    let address = auth_guard.address();
    let routes = Routes {
        path: args.file.clone(),
        options: input::options(&args.reading, project.as_ref())?,
        preview_state: Arc::clone(&preview_state),
        pen: Mutex::default(),
    };
    // Answer requests and watch the files on threads of their own.
    serve::begin(
        listener,
        auth_guard,
        Box::new(move |request| routes.answer(request)),
    )?;
    let watch = thread::Builder::new().name("watch".to_owned());
    let watch = watch.spawn(move || watched.run(&preview_state));
    watch.map_err(|error| serve::no_thread(&error))?;
    // Print the address and render until the end.
    output::to_stdout(format!("{address}\n").as_bytes())?;
    if args.open {
        serve::open(&address);
    }
    session.run()
}
