//! The server: bound to the loopback interface, with a limited number of connections. If all are
//! taken, the oldest without a request is closed, so that idle ones block nobody.

use super::Failure;
use super::http::{self, BadRequest, HttpReply, HttpRequest};
use super::reporter;
use std::collections::BTreeMap;
use std::io;
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// The most connections at a time, each with a thread of its own.
const MOST: usize = 32;

/// How long to wait where the system has no connection to give.
const PAUSE: Duration = Duration::from_millis(20);

/// What answers requests.
pub(super) type RequestHandler = dyn Fn(&HttpRequest) -> HttpReply + Send + Sync;

/// Authorisation: requests must have the token, a host name of this server, and the page's own
/// origin.
pub(super) struct AuthGuard {
    token: String,
    port: u16,
}

impl AuthGuard {
    /// A guard with a new token, for a port.
    pub(super) fn new(port: u16) -> Result<Self, Failure> {
        let token = random()?;
        Ok(Self { token, port })
    }

    /// The address of the page.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    /// Whether a request may come in.
    pub(super) fn admits(&self, request: &HttpRequest) -> bool {
        let names = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        let is_own = |host: &str| names.iter().any(|name| host.eq_ignore_ascii_case(name));
        let is_from_here = |origin: &String| origin.strip_prefix("http://").is_some_and(&is_own);
        let [host] = request.hosts.as_slice() else {
            return false;
        };
        let knows = request
            .value("token")
            .is_some_and(|token| is_equal(token, &self.token));
        knows && is_own(host) && request.sent_origins.iter().all(is_from_here)
    }
}

/// 128 random bits of the system, in hexadecimal digits.
pub(super) fn random() -> Result<String, Failure> {
    let mut bits = [0; 16];
    let none = |error| Failure::Failed(format!("the system gives no random numbers: {error}"));
    getrandom::fill(&mut bits).map_err(none)?;
    Ok(format!("{:032x}", u128::from_ne_bytes(bits)))
}

/// Whether two texts are equal, in a time that does not depend on where they differ.
fn is_equal(a: &str, b: &str) -> bool {
    let differing = a
        .bytes()
        .zip(b.bytes())
        .fold(0, |bits, (a, b)| bits | (a ^ b));
    a.len() == b.len() && std::hint::black_box(differing) == 0
}

/// The listener of a port of this machine, 0 for any that is free.
pub(super) fn bind(port: u16) -> Result<(TcpListener, u16), Failure> {
    let bound = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).and_then(|listener| {
        listener
            .local_addr()
            .map(|address| (listener, address.port()))
    });
    bound.map_err(|error| Failure::Failed(format!("can't listen on port {port}: {error}")))
}

/// Answers requests from now on, in threads of their own.
pub(super) fn begin(
    listener: TcpListener,
    auth_guard: AuthGuard,
    answer: Box<RequestHandler>,
) -> Result<(), Failure> {
    let (auth_guard, answer) = (Arc::new(auth_guard), Arc::<RequestHandler>::from(answer));
    let room = Arc::new(ConnectionPool::default());
    let serve = move || {
        for stream in listener.incoming() {
            let Ok(stream) = stream else {
                thread::sleep(PAUSE);
                continue;
            };
            let seat = ConnectionPermit::take(&room, stream);
            let (auth_guard, answer) = (Arc::clone(&auth_guard), Arc::clone(&answer));
            let worker = thread::Builder::new().name("connection".to_owned());
            if worker
                .spawn(move || seat.serve(&auth_guard, &*answer))
                .is_err()
            {
                thread::sleep(PAUSE);
            }
        }
    };
    let server = thread::Builder::new()
        .name("server".to_owned())
        .spawn(serve);
    server.map(drop).map_err(|error| no_thread(&error))
}

pub(super) fn no_thread(error: &io::Error) -> Failure {
    Failure::Failed(format!("can't start threads: {error}"))
}

/// The connections that are open.
#[derive(Default)]
struct ConnectionPool {
    /// By the order in which they came.
    guests: Mutex<BTreeMap<u64, Connection>>,
    left: Condvar,
}

struct Connection {
    stream: Arc<TcpStream>,
    /// The request has arrived, or the connection was asked to close.
    is_settled: bool,
}

impl ConnectionPool {
    fn guests(&self) -> MutexGuard<'_, BTreeMap<u64, Connection>> {
        self.guests.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The permit of a connection, released when dropped.
struct ConnectionPermit {
    room: Arc<ConnectionPool>,
    number: u64,
    stream: Arc<TcpStream>,
}

impl ConnectionPermit {
    /// Waits for a permit; if necessary, closes the oldest connection without a request.
    fn take(room: &Arc<ConnectionPool>, stream: TcpStream) -> Self {
        let mut guests = room.guests();
        while guests.len() >= MOST {
            let silent = guests
                .values_mut()
                .find(|connection| !connection.is_settled);
            if let Some(connection) = silent {
                connection.is_settled = true;
                // Its thread sees the end of the connection.
                let _ = connection.stream.shutdown(Shutdown::Both);
            }
            guests = room
                .left
                .wait(guests)
                .unwrap_or_else(PoisonError::into_inner);
        }
        let number = guests.last_key_value().map_or(0, |(last, _)| last + 1);
        let stream = Arc::new(stream);
        let connection = Connection {
            stream: Arc::clone(&stream),
            is_settled: false,
        };
        guests.insert(number, connection);
        Self {
            room: Arc::clone(room),
            number,
            stream,
        }
    }

    fn serve(self, auth_guard: &AuthGuard, answer: &RequestHandler) {
        let (reply, is_whole) = match http::read(&self.stream) {
            Ok(request) if auth_guard.admits(&request) => {
                self.settle();
                (answer(&request), true)
            }
            Ok(_) => (HttpReply::empty(403), true),
            Err(BadRequest::Refused(status)) => (HttpReply::empty(status), false),
            Err(BadRequest::Gone) => return,
        };
        // A client that has gone misses the reply.
        if reply.send(&self.stream).is_ok() && !is_whole {
            http::read_rest(&self.stream);
        }
    }

    /// The request has arrived: the connection is not closed any more.
    fn settle(&self) {
        if let Some(connection) = self.room.guests().get_mut(&self.number) {
            connection.is_settled = true;
        }
    }
}

impl Drop for ConnectionPermit {
    fn drop(&mut self) {
        self.room.guests().remove(&self.number);
        self.room.left.notify_all();
    }
}

/// Shows a page in the browser of the machine, if there is one.
pub(super) fn open(address: &str) {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let mut browser = std::process::Command::new(program);
    browser
        .arg(address)
        .stdin(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null());
    if let Err(error) = browser.spawn() {
        reporter::print_message(&format!("can't open a browser by `{program}`: {error}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_long_and_new_and_equal_to_themselves_alone() {
        let [a, b] = [random().unwrap(), random().unwrap()];
        assert!(a.len() == 32 && a != b);
        assert!(is_equal(&a, &a) && !is_equal(&a, &b));
        assert!(!is_equal(&a, "") && !is_equal("", &a) && !is_equal(&a, &format!("{a}0")));
    }
}
