//! With the feature `page`: the page for the browser as `web/build --program` packed it, or nothing where it did not.

use std::path::Path;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=JURIST_PAGE");
    if std::env::var_os("CARGO_FEATURE_PAGE").is_none() {
        return;
    }
    let packed = match std::env::var("JURIST_PAGE") {
        Ok(file) => {
            println!("cargo:rerun-if-changed={file}");
            std::fs::read(&file).unwrap_or_else(|error| panic!("JURIST_PAGE names {file}: {error}"))
        }
        Err(_) => Vec::new(),
    };
    let folder = std::env::var_os("OUT_DIR").expect("cargo sets it");
    std::fs::write(Path::new(&folder).join("page.lzma"), packed).expect("the folder is there");
}
