//! A server that makes thumbnails of scenes: `cargo run --release -- 127.0.0.1:8080`.
//!
//! `POST /model.glb?160x120` with a scene as the body answers with a PNG of at most that size, and
//! 422 with the errors if the scene has some. The extension of the name says what it is. A scene
//! reads no file but its own, and what it may take is limited by its size.

use rtc::{Error, Options, Scene};
use std::io::Read;
use std::thread;
use std::time::{Duration, Instant};
use tiny_http::{Header, Method, Request, Response, Server};

/// The most bytes of a scene.
const MAX_BODY: u64 = 16 << 20;
/// The most pixels along a side of a thumbnail.
const MAX_SIDE: u32 = 512;
/// The most rays of a thumbnail, and its most time.
const MAX_RAYS: u64 = 50_000_000;
const MAX_TIME: Duration = Duration::from_secs(20);

fn main() -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let address = std::env::args().nth(1);
    let server = Server::http(address.as_deref().unwrap_or("127.0.0.1:8080"))?;
    println!("http://{}", server.server_addr());
    serve(&server);
    Ok(())
}

/// Answers requests, one for each core at a time.
fn serve(server: &Server) {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                for mut request in server.incoming_requests() {
                    let answer = answer(&mut request);
                    // Who has gone needs no answer.
                    let _ = request.respond(answer);
                }
            });
        }
    });
}

type Answer = Response<std::io::Cursor<Vec<u8>>>;

fn answer(request: &mut Request) -> Answer {
    if *request.method() != Method::Post {
        return text(405, "POST a scene");
    }
    let url = request.url().to_owned();
    let Some((name, size)) = parse(&url) else {
        return text(
            400,
            "the path is /NAME?WIDTHxHEIGHT, as in /model.glb?160x120",
        );
    };
    let mut body = Vec::new();
    let read = request
        .as_reader()
        .take(MAX_BODY + 1)
        .read_to_end(&mut body);
    match read {
        Err(error) => return text(400, &error.to_string()),
        Ok(count) if count as u64 > MAX_BODY => return text(413, "the scene is too large"),
        Ok(_) => {}
    }
    match thumbnail(name, body, size) {
        Ok(png) => typed(200, png, "image/png"),
        Err(Error::Stopped) => text(503, "the picture takes too long"),
        Err(error) if error.diagnostics().is_empty() => text(400, &error.to_string()),
        Err(error) => {
            let found = error.diagnostics().iter().map(ToString::to_string);
            text(422, &found.collect::<Vec<_>>().join("\n\n"))
        }
    }
}

/// The name of the scene and the size of the thumbnail.
fn parse(url: &str) -> Option<(&str, [u32; 2])> {
    let (name, size) = url.strip_prefix('/')?.split_once('?')?;
    let (width, height) = size.split_once('x')?;
    let size = [width, height].map(|side| side.parse().ok());
    let [Some(width), Some(height)] = size.map(|side| side.filter(|side| *side <= MAX_SIDE)) else {
        return None;
    };
    let is_plain = !name.is_empty() && !name.contains('/');
    is_plain.then_some((name, [width, height]))
}

/// A PNG of a scene. It is a function of the scene and the size alone, so it can be cached by their
/// hash.
fn thumbnail(name: &str, body: Vec<u8>, [width, height]: [u32; 2]) -> Result<Vec<u8>, Error> {
    let scene = Scene::from_files(name, [(name.to_owned(), body)])?;
    let options = Options::new()
        .size(width, height)
        .threads(1)
        .max_rays(MAX_RAYS);
    let end = Instant::now() + MAX_TIME;
    let picture = scene.render_until(&options, &|| Instant::now() > end)?;
    picture.encode()
}

fn text(status: u16, words: &str) -> Answer {
    typed(status, words.into(), "text/plain; charset=utf-8")
}

fn typed(status: u16, body: Vec<u8>, kind: &str) -> Answer {
    let header = Header::from_bytes("Content-Type", kind).expect("it is a header");
    Response::from_data(body)
        .with_status_code(status)
        .with_header(header)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use std::net::TcpStream;

    const BALL: &str = "\
Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [320, 240], fov: 30}
Lights:
- {position: [5, 5, 9], color: [1, 1, 1]}
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1, material: {color: [1, 0, 0], ka: 0, kd: 1, ks: 0, n: 1}}
";

    /// The answer to a request, as bytes.
    fn ask(server: &Server, method: &str, path: &str, body: &str) -> Vec<u8> {
        let mut stream = TcpStream::connect(server.server_addr().to_ip().unwrap()).unwrap();
        let length = body.len();
        let head = format!("{method} {path} HTTP/1.0\r\nContent-Length: {length}\r\n\r\n");
        stream.write_all((head + body).as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        answer
    }

    /// The status of an answer, and its body.
    fn split(answer: &[u8]) -> (&str, &[u8]) {
        let end = answer
            .windows(4)
            .position(|four| four == b"\r\n\r\n")
            .unwrap();
        let head = std::str::from_utf8(&answer[..end]).unwrap();
        (head.split(' ').nth(1).unwrap(), &answer[end + 4..])
    }

    #[test]
    fn scenes_become_pictures_and_mistakes_become_words() {
        let server = Server::http("127.0.0.1:0").unwrap();
        thread::scope(|scope| {
            scope.spawn(|| serve(&server));
            // The thumbnail is the picture of the library.
            let answer = ask(&server, "POST", "/ball.yaml?32x24", BALL);
            let scene = Scene::from_files("a.yaml", [("a.yaml".to_owned(), BALL.into())]).unwrap();
            let picture = scene.render(&Options::new().size(32, 24)).unwrap();
            assert_eq!(split(&answer), ("200", &picture.encode().unwrap()[..]));
            // A mistake is told with its line.
            let broken = BALL.replace("radius: 1", "radius: -1");
            let answer = ask(&server, "POST", "/ball.yaml?32x24", &broken);
            let (status, words) = split(&answer);
            let words = std::str::from_utf8(words).unwrap();
            assert_eq!(status, "422");
            assert!(
                words.contains("VA002") && words.contains("ball.yaml:5"),
                "{words}"
            );
            // Other files are not read, and the size is limited.
            let other = BALL.replace("color: [1, 0, 0]", "texture: /etc/hostname");
            let answer = ask(&server, "POST", "/ball.yaml?32x24", &other);
            assert_eq!(split(&answer).0, "422");
            for path in [
                "/ball.yaml",
                "/ball.yaml?9999x24",
                "/a/ball.yaml?32x24",
                "/?32x24",
            ] {
                assert_eq!(split(&ask(&server, "POST", path, BALL)).0, "400", "{path}");
            }
            assert_eq!(split(&ask(&server, "GET", "/ball.yaml?32x24", "")).0, "405");
            // Wake all workers, which then end.
            let cores = thread::available_parallelism().map_or(1, usize::from);
            (0..cores).for_each(|_| server.unblock());
        });
    }
}
