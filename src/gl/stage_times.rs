//! How long each pass takes on the GPU, frame by frame, for a host's profiler.
//!
//! Two GL_TIMESTAMP queries a pass, so that a GL_TIME_ELAPSED query of the host may be running; some frames
//! are kept in flight, and their results taken when they have come, so that nothing waits. On llvmpipe a time
//! stamp is that of the last tile alone; there it waits before and after each pass, and takes the clock
//! instead.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::{Rc, Weak};
use std::time::{Duration, Instant};

use glow::HasContext as _;

use super::Gl;
use super::query::Query;
use crate::error::Result;

/// Frames that may be in flight, or wait to be fetched.
const FRAMES: usize = 8;

/// Times the passes of all pipelines of one [`Gl`], by their labels, from [`begin_frame`](Self::begin_frame)
/// to [`end_frame`](Self::end_frame).
///
/// ```no_run
/// # fn host(gl: &varikernel::Gl) -> varikernel::Result<()> {
/// let mut times = varikernel::gl::StageTimes::new(gl)?;
/// loop {
///     times.begin_frame();
///     // ... calls of pipelines ...
///     times.end_frame();
///     if let Some(frame) = times.poll() {
///         for (label, duration) in frame {
///             println!("{label}: {duration:?}");
///         }
///     }
/// #   return Ok(());
/// }
/// # }
/// ```
/// Without one, or between frames, nothing is timed. Queries are made in the first frames and used again.
/// What is not a pass is not timed: clears, uploads and read-backs.
#[derive(Debug)]
pub struct StageTimes {
    gl: Gl,
    recorder: Rc<RefCell<Recorder>>,
    fetched: Vec<(Rc<str>, Duration)>,
}

/// What passes record.
#[derive(Debug)]
pub(super) struct Recorder {
    waits: bool,
    labels: Vec<Rc<str>>,
    /// The frame that is being recorded.
    current: Option<Frame>,
    /// Recorded ones, the oldest first.
    recorded: VecDeque<Frame>,
    /// Fetched ones, to be used again.
    free: Vec<Frame>,
    /// When the current pass began, by the clock.
    began: Instant,
}

/// The passes of a frame, in their order.
#[derive(Debug, Default)]
struct Frame {
    /// Which label, and how long by the clock.
    stages: Vec<(usize, Duration)>,
    /// Begin and end of each pass, and perhaps more from an older frame.
    moments: Vec<[Query; 2]>,
}

impl StageTimes {
    /// Prepares to time; no query is made before the first pass.
    ///
    /// # Errors
    /// [`Error::ContextLost`](crate::Error::ContextLost).
    pub fn new(gl: &Gl) -> Result<Self> {
        gl.current()?;
        let recorder = Recorder {
            waits: gl.info().is_llvmpipe(),
            labels: Vec::new(),
            current: None,
            recorded: VecDeque::with_capacity(FRAMES),
            free: (0..FRAMES).map(|_| Frame::default()).collect(),
            began: Instant::now(),
        };
        Ok(Self { gl: gl.clone(), recorder: Rc::new(RefCell::new(recorder)), fetched: Vec::new() })
    }

    /// Whether it waits for the GPU before and after each pass: on llvmpipe alone.
    #[must_use]
    pub fn waits(&self) -> bool {
        self.recorder.borrow().waits
    }

    /// Times the passes from now on; another one that was timing this [`Gl`] stops.
    ///
    /// The frame is left out if 8 frames before it are still in flight. Of frames that came but were not
    /// fetched, the oldest is forgotten.
    pub fn begin_frame(&mut self) {
        self.recorder.borrow_mut().begin_frame();
        *self.gl.inner.stage_times.borrow_mut() = Rc::downgrade(&self.recorder);
    }

    /// Ends the frame; passes are no longer timed.
    pub fn end_frame(&mut self) {
        let mut recorder = self.recorder.borrow_mut();
        if let Some(frame) = recorder.current.take() {
            recorder.recorded.push_back(frame);
        }
        let mut timing = self.gl.inner.stage_times.borrow_mut();
        if std::ptr::eq(timing.as_ptr(), Rc::as_ptr(&self.recorder)) {
            *timing = Weak::new();
        }
    }

    /// The oldest frame that was not fetched yet, if its results have come: each label once, in the order of
    /// first appearance, with the time of all its passes together. Never waits.
    pub fn poll(&mut self) -> Option<impl ExactSizeIterator<Item = (&str, Duration)>> {
        let recorder = &mut *self.recorder.borrow_mut();
        if !recorder.recorded.front()?.has_come(recorder.waits) {
            return None;
        }
        let frame = recorder.recorded.pop_front()?;
        self.fetched.clear();
        for (index, &(label, by_clock)) in frame.stages.iter().enumerate() {
            let label = &recorder.labels[label];
            let duration = if recorder.waits { by_clock } else { frame.by_queries(index) };
            match self.fetched.iter_mut().find(|(known, _)| known == label) {
                Some((_, sum)) => *sum += duration,
                None => self.fetched.push((Rc::clone(label), duration)),
            }
        }
        recorder.free.push(frame);
        Some(self.fetched.iter().map(|(label, duration)| (&**label, *duration)))
    }
}

impl Recorder {
    fn begin_frame(&mut self) {
        let abandoned = self.current.take();
        let oldest_has_come = self.recorded.front().is_some_and(|oldest| oldest.has_come(self.waits));
        let mut frame = abandoned.or_else(|| self.free.pop());
        if frame.is_none() && oldest_has_come {
            frame = self.recorded.pop_front();
        }
        self.current = frame.map(|mut frame| {
            frame.stages.clear();
            frame
        });
    }

    /// A pass begins.
    pub(super) fn begin(&mut self, gl: &Gl, label: &str) {
        let (Some(frame), Some(glow)) = (&mut self.current, gl.live()) else { return };
        let known = self.labels.iter().position(|known| **known == *label);
        let label = known.unwrap_or_else(|| {
            self.labels.push(label.into());
            self.labels.len() - 1
        });
        let index = frame.stages.len();
        frame.stages.push((label, Duration::ZERO));
        if self.waits {
            // SAFETY: the context is current while the handle lives.
            unsafe { glow.finish() };
            self.began = Instant::now();
            return;
        }
        if index == frame.moments.len() {
            match Query::of_moments(gl).and_then(|begin| Ok([begin, Query::of_moments(gl)?])) {
                Ok(moments) => frame.moments.push(moments),
                Err(error) => {
                    // Without a query the frame is drawn all the same, but not timed.
                    tracing::warn!(%error, "a frame is not timed");
                    self.free.extend(self.current.take());
                    return;
                }
            }
        }
        frame.moments[index][0].stamp();
    }

    /// The pass that began last ends.
    pub(super) fn end(&mut self, gl: &Gl) {
        let (Some(frame), Some(glow)) = (&mut self.current, gl.live()) else { return };
        let index = frame.stages.len() - 1;
        if self.waits {
            // SAFETY: the context is current while the handle lives.
            unsafe { glow.finish() };
            frame.stages[index].1 = self.began.elapsed();
        } else {
            frame.moments[index][1].stamp();
        }
    }
}

impl Frame {
    /// Whether all results have come; those of time stamps come in their order.
    fn has_come(&self, waits: bool) -> bool {
        let last = self.stages.len().checked_sub(1).and_then(|last| self.moments.get(last));
        waits || last.is_none_or(|[_, end]| end.has_result())
    }

    fn by_queries(&self, index: usize) -> Duration {
        let [begin, end] = &self.moments[index];
        Duration::from_nanos(end.result().saturating_sub(begin.result()))
    }
}
