//! A headless Chromium, driven by its DevTools protocol.

use std::io::Read;
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

use crate::PATIENCE;

/// Names under which it is installed.
const NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// With a fresh profile, and nothing that asks the network for anything.
const FLAGS: [&str; 10] = [
    "--headless",
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1200,1000",
    "--remote-debugging-port=0",
    "about:blank",
];

/// A browser with one page; ends with the value.
pub(crate) struct Chromium {
    process: Child,
    socket: WebSocket<TcpStream>,
    session: Option<String>,
    next_id: u64,
    exceptions: Vec<String>,
}

impl Chromium {
    /// Starts one with its profile in a folder; `None`, and a word about it, where none is installed.
    ///
    /// With `TETRASCOPE_REQUIRE_BROWSER` in the environment that is a failure.
    pub(crate) fn start(folder: &Path) -> Option<Self> {
        let profile = folder.join("profile");
        let start = |name: &&str| {
            let data = format!("--user-data-dir={}", profile.display());
            let output = (Stdio::null(), Stdio::null());
            Command::new(name).args(FLAGS).arg(data).stdout(output.0).stderr(output.1).spawn().ok()
        };
        let Some(mut process) = NAMES.iter().find_map(start) else {
            assert!(
                std::env::var_os("TETRASCOPE_REQUIRE_BROWSER").is_none(),
                "none of {NAMES:?} was started; install Debian's package chromium"
            );
            #[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
            {
                eprintln!("SKIPPED: the page was not looked at, as none of {NAMES:?} is installed");
            }
            return None;
        };
        match connect(&profile) {
            Some(socket) => {
                let mut browser = Self { process, socket, session: None, next_id: 0, exceptions: Vec::new() };
                browser.attach();
                Some(browser)
            }
            None => {
                let _ = process.kill();
                let _ = process.wait();
                panic!("the browser did not say how it is reached");
            }
        }
    }

    fn attach(&mut self) {
        let target = self.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attached = self.call("Target.attachToTarget", json!({ "targetId": target["targetId"], "flatten": true }));
        self.session = Some(attached["sessionId"].as_str().unwrap().to_owned());
        self.call("Runtime.enable", json!({}));
    }

    /// Opens a file and waits until all of it is there.
    pub(crate) fn open(&mut self, page: &Path) {
        self.call("Page.navigate", json!({ "url": format!("file://{}", page.display()) }));
        let is_there = "location.protocol === 'file:' && document.readyState === 'complete' ? 'there' : ''";
        assert_eq!(self.wait_for(is_there), "there");
    }

    /// The value of an expression, which the page may precede with declarations.
    fn value(&mut self, script: &str) -> Value {
        // A block of its own, so that names may be declared again and again; the value of its last statement is given.
        let answer =
            self.call("Runtime.evaluate", json!({ "expression": format!("{{ {script} }}"), "returnByValue": true }));
        assert!(answer["exceptionDetails"].is_null(), "{script}: {answer}");
        answer["result"]["value"].clone()
    }

    pub(crate) fn number(&mut self, script: &str) -> f64 {
        let value = self.value(script);
        value.as_f64().unwrap_or_else(|| panic!("{script} is {value}"))
    }

    pub(crate) fn text(&mut self, script: &str) -> String {
        let value = self.value(script);
        value.as_str().unwrap_or_else(|| panic!("{script} is {value}")).to_owned()
    }

    /// The text once it is not empty any more; empty if it never is.
    pub(crate) fn wait_for(&mut self, script: &str) -> String {
        let start = Instant::now();
        loop {
            let text = self.text(script);
            if !text.is_empty() || start.elapsed() > PATIENCE {
                return text;
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
    }

    /// The mouse, as if a hand moved it; places are in the window.
    pub(crate) fn mouse(&mut self, kind: &str, x: f64, y: f64) {
        let button = if kind == "mouseMoved" { "none" } else { "left" };
        let count = i32::from(button == "left");
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "clickCount": count });
        self.call("Input.dispatchMouseEvent", event);
    }

    /// What the page's scripts threw and did not catch.
    pub(crate) fn exceptions(&self) -> Vec<String> {
        self.exceptions.clone()
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.next_id += 1;
        let id = self.next_id;
        let mut message = json!({ "id": id, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        self.socket.send(Message::text(message.to_string())).unwrap();
        loop {
            let Message::Text(text) = self.socket.read().unwrap() else { continue };
            let said: Value = serde_json::from_str(&text).unwrap();
            if said["method"] == "Runtime.exceptionThrown" {
                self.exceptions.push(said["params"].to_string());
            }
            if said["id"] == id {
                assert!(said["error"].is_null(), "{method}: {said}");
                return said["result"].clone();
            }
        }
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        // Asked to close, it ends its own helpers too; they write into the profile until then.
        let close = json!({ "id": 0, "method": "Browser.close" });
        let is_asked = self.socket.send(Message::text(close.to_string())).is_ok();
        let mut rest = Vec::new();
        let _ = self.socket.get_mut().read_to_end(&mut rest);
        if !is_asked {
            let _ = self.process.kill();
        }
        let _ = self.process.wait();
    }
}

/// Where the browser listens stands in a file of its profile, once it does.
fn connect(profile: &Path) -> Option<WebSocket<TcpStream>> {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        let text = std::fs::read_to_string(profile.join("DevToolsActivePort")).unwrap_or_default();
        if let Some((port, path)) = text.split_once('\n')
            && let Ok(stream) = TcpStream::connect(format!("127.0.0.1:{port}"))
        {
            stream.set_read_timeout(Some(PATIENCE)).unwrap();
            let address = format!("ws://127.0.0.1:{port}{}", path.trim());
            return tungstenite::client(address, stream).ok().map(|(socket, _)| socket);
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    None
}
