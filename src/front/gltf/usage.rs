//! The usage of each accessor. An accessor has one usage only.

use super::report::AssetReport;
use rtc_diag::codes;
use rtc_source::tree::NodeId;

/// The usage of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AccessorUsage {
    Vertices,
    Indices,
    InverseBindMatrices,
    Times,
    Keyframes,
}

impl AccessorUsage {
    fn name(self) -> &'static str {
        match self {
            Self::Vertices => "vertices",
            Self::Indices => "indices",
            Self::InverseBindMatrices => "inverse bind matrices",
            Self::Times => "times of an animation",
            Self::Keyframes => "keyframes of an animation",
        }
    }
}

/// The usages found for each accessor.
pub(super) struct AccessorUsages(Vec<Option<AccessorUsage>>);

impl AccessorUsages {
    pub(super) fn new(count: usize) -> Self {
        Self(vec![None; count])
    }

    /// Takes down that the node `at` uses an accessor so; two usages don't go together.
    pub(super) fn set(
        &mut self,
        accessor: usize,
        usage: AccessorUsage,
        at: NodeId,
        report: &mut AssetReport<'_, '_>,
    ) {
        let Some(slot) = self.0.get_mut(accessor) else {
            return;
        };
        match slot {
            None => *slot = Some(usage),
            Some(first) if *first != usage => {
                let message = format!(
                    "the accessor is used for {} here, but for {} elsewhere",
                    usage.name(),
                    first.name()
                );
                report.add(
                    &codes::GLTF_ACCESSOR,
                    "ACCESSOR_USAGE_OVERRIDE",
                    at,
                    message,
                );
            }
            Some(_) => {}
        }
    }
}
