//! The decay rate of all roots.

use super::{Meaning, RequirementKind, not_understood};
use crate::model::Time;
use crate::model::requirements::DECAY;
use crate::problem::Region;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: DECAY.name,
    about: DECAY.about,
    option: None,
    is_listed: false,
    sense: ">=",
    units: &[],
    meaning: |written| match written.time {
        Time::Continuous => Ok(Meaning::Region(Region::half_plane(written.value.clone()))),
        _ => Err(not_understood(KIND.name, "a decay rate is required of continuous loops")),
    },
    found: |_, _| None,
};
