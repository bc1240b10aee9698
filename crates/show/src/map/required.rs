//! Where requirements are met in a map, for people.

use super::super::intervals::extent_line;
use jurist_engine::problem::Problem;
use jurist_engine::response::{RequiredMap, RequiredRegions, Requirement};

/// What is required, and how far each region reaches.
pub(super) fn required_text(found: &RequiredMap, problem: &Problem, digits: usize) -> String {
    let at = found.at.as_ref().map(|at| format!(", the loop cut at '{at}'")).unwrap_or_default();
    let mut out = format!("inside the stable points{at}\n");
    for set in &found.regions {
        out.push_str(&set_text(set, found, problem, digits));
    }
    out
}

fn set_text(set: &RequiredRegions, found: &RequiredMap, problem: &Problem, digits: usize) -> String {
    let name = match set.requirements.as_slice() {
        [one] => found.requirements[*one].text(),
        all if all.len() == found.requirements.len() => "all together".to_owned(),
        some => some.iter().map(|k| Requirement::text(&found.requirements[*k])).collect::<Vec<_>>().join(", "),
    };
    let regions = &set.map.regions;
    let mut out = match regions.len() {
        0 => return format!("    {name}: met in no open region\n"),
        1 => format!("    {name}: met in 1 region\n"),
        count => format!("    {name}: met in {count} regions\n"),
    };
    for region in regions {
        let extents = problem
            .axes()
            .into_iter()
            .zip([&region.x, &region.y])
            .map(|(axis, extent)| extent_line(&axis.name, extent, digits));
        out.push_str(&format!("        {}\n", extents.collect::<Vec<_>>().join("   ")));
    }
    out
}
