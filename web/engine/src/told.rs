//! How far long work is, told to the page while it runs.

use jurist::{Budget, Progress};
use std::sync::{Arc, Mutex};

/// Without end, telling the page its steps: the page ends work by throwing the instance away.
pub(crate) fn budget() -> Budget {
    Budget::unlimited().reporting_to(Arc::new(Told(Mutex::default())))
}

/// The step that began last, and the last share told, in percent.
struct Told(Mutex<(String, u64)>);

impl Progress for Told {
    fn step(&self, name: &str) {
        if let Ok(mut told) = self.0.lock() {
            *told = (name.to_owned(), 0);
            tell(name);
        }
    }

    fn advance(&self, done: u64, total: u64) {
        let Ok(mut told) = self.0.lock() else { return };
        let share = (100 * done).checked_div(total).unwrap_or(0);
        if share > told.1 {
            told.1 = share;
            tell(&format!("{}, {share} %", told.0));
        }
    }
}

#[cfg(target_family = "wasm")]
#[allow(unsafe_code, reason = "a function of the page")]
fn tell(text: &str) {
    #[link(wasm_import_module = "page")]
    unsafe extern "C" {
        safe fn progress(at: *const u8, length: usize);
    }
    progress(text.as_ptr(), text.len());
}

#[cfg(not(target_family = "wasm"))]
fn tell(_: &str) {}
