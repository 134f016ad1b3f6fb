//! `rtc preview`: a page that shows a scene while it is edited: a server on this machine, a watch on
//! the files of the scene, and a session that renders.

mod board;
mod costs;
mod crude;
mod http;
mod news;
mod pixels;
mod routes;
mod serve;
mod session;
mod shots;
mod view;
mod watch;

use super::interrupt::{self, Interrupt};
use super::project::Project;
use super::{Failure, args, input, output, render, talk};
use crate::image::{FileFormat, Picture, PictureHead, ShownPicture};
use crate::source::{Loader, SourceMap};
use board::Board;
use routes::Routes;
use serve::Door;
use session::Session;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::thread;
use watch::Watched;

/// The largest picture file that is compared with, in bytes, and the most pixels of it.
const MAX_BYTES: u64 = 1 << 30;
const MAX_PIXELS: u64 = 1 << 25;

/// Shows the scene until told to stop.
pub(super) fn run(args: &args::Preview) -> Result<(), Failure> {
    if args.file.as_os_str() == "-" {
        let words = "standard input is read once, so there is nothing to preview; give a file";
        return Err(Failure::Trouble(words.to_owned()));
    }
    let interrupt = Interrupt::listen()?;
    let against = match &args.against {
        Some(path) if input::is_picture(path) => Some(picture(path)?),
        Some(path) => Some(shots::of_scene(args, path, &interrupt)?),
        None => None,
    };
    let (board, watched) = (Arc::new(Board::default()), Arc::new(Watched::default()));
    let session = Session::new(args, Arc::clone(&board), Arc::clone(&watched))?;
    let (listener, port) = serve::bind(args.port)?;
    let door = Door::new(port)?;
    let project = Project::of(&args.file)?;
    let address = door.address();
    let routes = Routes {
        path: args.file.clone(),
        options: input::options(&args.reading, project.as_ref())?,
        board: Arc::clone(&board),
        against,
        pen: Mutex::default(),
    };
    serve::begin(
        listener,
        door,
        Box::new(move |request| routes.answer(request)),
    )?;
    let watch = thread::Builder::new().name("watch".to_owned());
    let watch = watch.spawn(move || watched.run(&board));
    watch.map_err(|error| serve::no_thread(&error))?;
    output::to_stdout(format!("{address}\n").as_bytes())?;
    if args.open {
        serve::open(&address);
    }
    session.run()
}

/// The picture in a file, as a PNG.
fn picture(path: &Path) -> Result<Arc<Vec<u8>>, Failure> {
    let refused = |words: String| Failure::Trouble(format!("`{}`: {words}", path.display()));
    let bytes = Loader.bytes(path, MAX_BYTES, &SourceMap::default());
    let bytes = bytes.map_err(|error| refused(error.to_string()))?;
    let shown = ShownPicture::read(&bytes, MAX_PIXELS);
    let picture = Picture {
        image: shown.map_err(|error| refused(error.to_string()))?.display,
        ..Picture::default()
    };
    let png = PictureHead::of(&picture, FileFormat::Png8).encode(&picture);
    png.map(Arc::new)
        .map_err(|error| refused(error.to_string()))
}
