//! The radius of a disk in which all roots lie.

use super::{Meaning, RequirementKind, not_understood};
use crate::model::Time;
use crate::model::requirements::RADIUS;
use crate::problem::Region;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: RADIUS.name,
    about: RADIUS.about,
    option: None,
    is_listed: false,
    sense: "<=",
    units: &[],
    meaning: |written| match written.time {
        Time::Discrete => Ok(Meaning::Region(Region::disc(written.value.clone())?)),
        _ => Err(not_understood(KIND.name, "a radius is required of discrete loops")),
    },
    found: |_, _| None,
};
