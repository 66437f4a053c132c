//! A display server of its own for each test, and what a user does there: mouse, keys, drops and screenshots.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use glam::UVec2;
use varikernel::Image;
use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConfigureWindowAux, ConnectionExt as _,
    CreateWindowAux, EventMask, ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT,
    MOTION_NOTIFY_EVENT, PropMode, SelectionNotifyEvent, Window, WindowClass,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

/// As long as anything may take on a busy machine without a GPU.
const PATIENCE: Duration = Duration::from_mins(4);

/// Xvfb, which ends with this.
pub(crate) struct Display {
    server: Child,
    name: String,
    connection: RustConnection,
    root: Window,
}

impl Drop for Display {
    fn drop(&mut self) {
        self.server.kill().unwrap();
        self.server.wait().unwrap();
    }
}

impl Display {
    /// Starts Xvfb on a number that is free.
    pub(crate) fn new() -> Self {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x1000x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb is there: .ci/install-gl installs it");
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let name = format!(":{}", number.trim());
        let (connection, screen) = x11rb::connect(Some(&name)).unwrap();
        let root = connection.setup().roots[screen].root;
        Self { server, name, connection, root }
    }

    /// The program, to be run here.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = program();
        command.args(arguments).env("DISPLAY", &self.name);
        command
    }

    /// Runs the program here until its title holds `words`.
    pub(crate) fn open(&self, arguments: &[&str], words: &str) -> Program<'_> {
        let child = self.command(arguments).spawn().unwrap();
        let mut program = Program { display: self, child, window: self.root };
        program.window = wait(|| program.find());
        // Without a window manager, nothing else gives it the keyboard focus.
        wait(|| {
            let focus =
                self.connection.set_input_focus(InputFocus::PARENT, program.window, x11rb::CURRENT_TIME);
            focus.unwrap().check().ok()
        });
        program.wait_for(words);
        program
    }

    fn atom(&self, name: &str) -> u32 {
        self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
    }

    fn fake(&self, kind: u8, detail: u8, place: (i16, i16)) {
        self.connection.xtest_fake_input(kind, detail, 0, self.root, place.0, place.1, 0).unwrap();
        self.connection.sync().unwrap();
    }
}

/// The program, without any display.
pub(crate) fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_varikernel"));
    command.arg("view").env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command.env_remove("RUST_LOG");
    command
}

/// The program in its window; killed with this if it still runs.
pub(crate) struct Program<'a> {
    display: &'a Display,
    child: Child,
    window: Window,
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Program<'_> {
    fn find(&mut self) -> Option<Window> {
        assert!(self.child.try_wait().unwrap().is_none(), "the program ended");
        let tree = self.display.connection.query_tree(self.display.root).unwrap().reply().unwrap();
        tree.children.into_iter().find(|&window| self.title_of(window).contains("varikernel"))
    }

    fn title_of(&self, window: Window) -> String {
        let display = self.display;
        let (name, utf8) = (display.atom("_NET_WM_NAME"), display.atom("UTF8_STRING"));
        let property = display.connection.get_property(false, window, name, utf8, 0, 1000).unwrap();
        property.reply().map_or(String::new(), |reply| String::from_utf8(reply.value).unwrap())
    }

    pub(crate) fn title(&self) -> String {
        self.title_of(self.window)
    }

    pub(crate) fn wait_for(&mut self, words: &str) {
        wait(|| {
            assert!(self.child.try_wait().unwrap().is_none(), "the program ended: {}", self.title());
            self.title().contains(words).then_some(())
        });
    }

    /// What is seen of the window.
    pub(crate) fn look(&self) -> Image<[u8; 3]> {
        let connection = &self.display.connection;
        let size = connection.get_geometry(self.window).unwrap().reply().unwrap();
        let (width, height) = (size.width, size.height);
        let image =
            connection.get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, width, height, u32::MAX).unwrap();
        let bytes = image.reply().unwrap().data;
        let colours = bytes.chunks_exact(4).map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect();
        Image::from_values(UVec2::new(width.into(), height.into()), colours)
    }

    /// What is seen once it stays as it is, for longer than a frame takes on a busy machine.
    #[track_caller]
    pub(crate) fn look_at_rest(&self) -> Image<[u8; 3]> {
        let mut before = self.look();
        let mut same = 0;
        self.look_until("rest", |seen| {
            sleep(Duration::from_millis(500));
            same = if std::mem::replace(&mut before, seen.clone()) == *seen { same + 1 } else { 0 };
            same == 5
        })
    }

    /// What is seen once it is what `expected` says.
    #[track_caller]
    pub(crate) fn look_until(
        &self,
        what: &str,
        mut expected: impl FnMut(&Image<[u8; 3]>) -> bool,
    ) -> Image<[u8; 3]> {
        let begun = Instant::now();
        loop {
            let seen = self.look();
            if expected(&seen) {
                return seen;
            }
            assert!(begun.elapsed() < PATIENCE, "{what} did not come: {}", self.title());
            sleep(Duration::from_millis(50));
        }
    }

    pub(crate) fn point(&self, at: (i16, i16)) {
        self.display.fake(MOTION_NOTIFY_EVENT, 0, at);
    }

    /// With the left button, from one place to another.
    pub(crate) fn drag(&self, from: (i16, i16), to: (i16, i16)) {
        self.point(from);
        sleep(Duration::from_millis(100));
        self.display.fake(BUTTON_PRESS_EVENT, 1, from);
        // egui takes moves one frame at a time.
        for step in 1..=4 {
            let between = |from: i16, to: i16| from + (to - from) * step / 4;
            self.point((between(from.0, to.0), between(from.1, to.1)));
            sleep(Duration::from_millis(100));
        }
        self.display.fake(BUTTON_RELEASE_EVENT, 1, to);
    }

    /// Does something while the program is too busy to react.
    pub(crate) fn while_busy(&self, act: impl FnOnce()) {
        let signal = |name: &str| {
            let status = Command::new("kill").args([name, &self.child.id().to_string()]).status().unwrap();
            assert!(status.success(), "{name}");
        };
        signal("-STOP");
        act();
        signal("-CONT");
    }

    /// Presses the key of a letter.
    pub(crate) fn press(&self, letter: char) {
        let setup = self.display.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let keys =
            self.display.connection.get_keyboard_mapping(first, last - first + 1).unwrap().reply().unwrap();
        let mut codes = keys.keysyms.chunks(keys.keysyms_per_keycode.into());
        let code = codes.position(|symbols| symbols[0] == u32::from(letter)).unwrap();
        let code = first + u8::try_from(code).unwrap();
        self.display.fake(KEY_PRESS_EVENT, code, (0, 0));
        self.display.fake(KEY_RELEASE_EVENT, code, (0, 0));
    }

    pub(crate) fn resize(&self, width: u32, height: u32) {
        let connection = &self.display.connection;
        let aux = ConfigureWindowAux::new().width(width).height(height);
        connection.configure_window(self.window, &aux).unwrap().check().unwrap();
    }

    /// As the button of a window manager does.
    pub(crate) fn close(&self) {
        let delete = self.display.atom("WM_DELETE_WINDOW");
        self.send("WM_PROTOCOLS", [delete, 0, 0, 0, 0]);
    }

    /// Drops a file, as file managers do: the XDND protocol from the side of its source.
    pub(crate) fn drop_file(&self, path: &Path) {
        let (display, connection) = (self.display, &self.display.connection);
        let source = connection.generate_id().unwrap();
        let (aux, parent) = (CreateWindowAux::new(), display.root);
        let class = WindowClass::INPUT_OUTPUT;
        connection.create_window(0, source, parent, 0, 0, 1, 1, 0, class, 0, &aux).unwrap().check().unwrap();
        let (selection, list) = (display.atom("XdndSelection"), display.atom("text/uri-list"));
        connection.set_selection_owner(source, selection, x11rb::CURRENT_TIME).unwrap().check().unwrap();
        self.send("XdndEnter", [source, 5 << 24, list, 0, 0]);
        self.send("XdndPosition", [source, 0, 0, x11rb::CURRENT_TIME, display.atom("XdndActionCopy")]);
        // The program asks what is dropped; only then is the button released.
        let request = wait(|| match connection.poll_for_event().unwrap() {
            Some(Event::SelectionRequest(request)) => Some(request),
            _ => None,
        });
        let text = format!("file://{}\r\n", path.display());
        let property = connection.change_property8(
            PropMode::REPLACE,
            request.requestor,
            request.property,
            list,
            text.as_bytes(),
        );
        property.unwrap().check().unwrap();
        let answer = SelectionNotifyEvent {
            response_type: 31,
            sequence: 0,
            time: request.time,
            requestor: request.requestor,
            selection: request.selection,
            target: request.target,
            property: request.property,
        };
        connection
            .send_event(false, request.requestor, EventMask::NO_EVENT, answer)
            .unwrap()
            .check()
            .unwrap();
        self.send("XdndDrop", [source, 0, x11rb::CURRENT_TIME, 0, 0]);
    }

    fn send(&self, kind: &str, data: [u32; 5]) {
        let message = ClientMessageEvent::new(32, self.window, self.display.atom(kind), data);
        let connection = &self.display.connection;
        connection.send_event(false, self.window, EventMask::NO_EVENT, message).unwrap().check().unwrap();
    }

    /// How it ended.
    pub(crate) fn end(mut self) -> ExitStatus {
        wait(|| self.child.try_wait().unwrap())
    }
}

/// Waits for the result of `found`.
#[track_caller]
fn wait<T>(mut found: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(begun.elapsed() < PATIENCE, "waited for too long");
        sleep(Duration::from_millis(30));
    }
}
