//! JSON Schemas of all documents that the program writes, and of model files.
//!
//! A document names its kind and version under `schema`. The schemas are made of the types in
//! [`documents`](crate::documents), `jurist_draw::document` and `jurist_drive::document`, with one test each that the
//! files of the folder `schema` are still those of the types. A kind keeps its version while keys are only added, so a
//! reader should let keys pass that it does not know.
//!
//! Exact numbers are texts, `p/q` or an integer; JSON numbers are rounded values and counts. An answer that the budget did
//! not allow has `null` where the answer would stand and says why under `undecided`.

macro_rules! schemas {
    ($($name:ident: $about:literal, $file:literal;)*) => {$(
        #[doc = $about]
        #[doc = concat!("\n\n```json\n", include_str!(concat!("../../schema/", $file, ".schema.json")), "```")]
        pub mod $name {}
    )*};
}

schemas! {
    analyze: "`jurist/analyze/1`, of `jurist analyze`.", "analyze-1";
    body: "`jurist/body/1`, of `jurist map -z`.", "body-1";
    charpoly: "`jurist/charpoly/1`, of `jurist charpoly`.", "charpoly-1";
    check: "`jurist/check/1`, of `jurist check --json`.", "check-1";
    frequency_response: "`jurist/frequency-response/1`, of `jurist bode` and `jurist nyquist`.", "frequency-response-1";
    intervals: "`jurist/intervals/1`, of `jurist intervals`.", "intervals-1";
    jury: "`jurist/jury/1`, of `jurist jury`.", "jury-1";
    least_margins: "`jurist/least-margins/1`, of `jurist margins --for-all`.", "least-margins-1";
    locus: "`jurist/locus/1`, of `jurist locus`.", "locus-1";
    lock: "`jurist/lock/1`, of `jurist lock`.", "lock-1";
    main: "`jurist/main/1`, of `jurist` without a command.", "main-1";
    map: "`jurist/map/1`, of `jurist map`.", "map-1";
    map_boxes: "`jurist/map-boxes/1`, of `jurist map --method boxes`.", "map-boxes-1";
    margin_ranges: "`jurist/margin-ranges/1`, of `jurist margins --param`.", "margin-ranges-1";
    margins: "`jurist/margins/1`, of `jurist margins`.", "margins-1";
    model: "Model files; the line `#:schema` names it to editors.", "model";
    norm: "`jurist/norm/1`, of `jurist norm`.", "norm-1";
    root_locus_form: "`jurist/root-locus-form/1`, of `jurist charpoly --root-locus-form`.", "root-locus-form-1";
    roots: "`jurist/roots/1`, of `jurist roots`.", "roots-1";
    ship: "`jurist/ship/1`, of `jurist ship`.", "ship-1";
    simulate: "`jurist/simulate/1`, of `jurist simulate`.", "simulate-1";
    test: "`jurist/test/1`, of `jurist test --json`.", "test-1";
    tolerance: "`jurist/tolerance/1`, of `jurist tolerance`.", "tolerance-1";
    transfer: "`jurist/transfer/1`, of `jurist charpoly --transfer`.", "transfer-1";
    tune: "`jurist/tune/1`, of `jurist tune`.", "tune-1";
    verdict: "`jurist/verdict/1`, of `jurist verdict`.", "verdict-1";
}
