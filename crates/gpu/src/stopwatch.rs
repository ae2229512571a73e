//! How long the device takes for each stage of a frame, where it tells.

use std::time::Duration;

use tetrascope_scene::Stage;
use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePassTimestampWrites, QuerySet, RenderPassTimestampWrites};

use crate::Gpu;

/// Most passes of a frame that are measured; of one with more nothing is said.
const MOST: u32 = 512;

/// Times when passes begin and end.
#[derive(Debug)]
pub(crate) struct DeviceStopwatch {
    queries: QuerySet,
    resolved: Buffer,
    period_nanos: f64,
}

/// The passes of one frame.
#[derive(Debug)]
pub(crate) struct Laps<'a> {
    watch: Option<&'a DeviceStopwatch>,
    stages: Vec<Stage>,
}

impl DeviceStopwatch {
    /// Bytes of the times of a frame, at most.
    pub(crate) const BYTES: u64 = 2 * MOST as u64 * 8;

    /// `None` if the device does not tell.
    pub(crate) fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let queries = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("stages"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * MOST,
        });
        let resolved = gpu.buffer("stage times", Self::BYTES, BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC);
        Some(Self { queries, resolved, period_nanos: f64::from(gpu.queue.get_timestamp_period()) })
    }

    /// Where the times of a frame are, after [`Laps::resolve`].
    pub(crate) fn resolved(&self) -> &Buffer {
        &self.resolved
    }

    /// The time of each stage, in the order in which they began; of the bytes of [`Self::resolved`].
    pub(crate) fn stages(&self, stages: &[Stage], bytes: &[u8]) -> Vec<(Stage, Duration)> {
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(bytes);
        let mut times: Vec<(Stage, Duration)> = Vec::new();
        for (stage, pair) in stages.iter().zip(ticks.chunks_exact(2)) {
            let nanos = pair[1].saturating_sub(pair[0]) as f64 * self.period_nanos;
            let time = Duration::from_nanos(nanos as u64);
            match times.iter_mut().find(|(known, _)| known == stage) {
                Some((_, sum)) => *sum += time,
                None => times.push((*stage, time)),
            }
        }
        times
    }
}

impl<'a> Laps<'a> {
    /// No pass yet.
    pub(crate) fn new(watch: Option<&'a DeviceStopwatch>) -> Self {
        Self { watch, stages: Vec::new() }
    }

    fn next(&mut self, stage: Stage) -> Option<(&'a QuerySet, u32)> {
        let watch = self.watch?;
        if self.stages.len() as u32 == MOST {
            // Half of a frame is worse than nothing.
            self.watch = None;
            self.stages.clear();
            return None;
        }
        self.stages.push(stage);
        Some((&watch.queries, 2 * (self.stages.len() as u32 - 1)))
    }

    /// For a compute pass of a stage.
    pub(crate) fn compute(&mut self, stage: Stage) -> Option<ComputePassTimestampWrites<'a>> {
        let (query_set, first) = self.next(stage)?;
        Some(ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// For a render pass of a stage.
    pub(crate) fn render(&mut self, stage: Stage) -> Option<RenderPassTimestampWrites<'a>> {
        let (query_set, first) = self.next(stage)?;
        Some(RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Makes the times readable, when all passes are there; gives their stages.
    pub(crate) fn resolve(self, encoder: &mut CommandEncoder) -> Vec<Stage> {
        if let Some(watch) = self.watch.filter(|_| !self.stages.is_empty()) {
            encoder.resolve_query_set(&watch.queries, 0..2 * self.stages.len() as u32, &watch.resolved, 0);
        }
        self.stages
    }
}
