//! All tests of the workspace that are more than one file's own: one binary, a room for each subject.

/// Written once: loading models, numbers, running the program, both checkers, expected answers.
mod helpers;

/// Laws of the algebra and of stability, on generated input: every algorithm against a second one.
mod laws {
    mod cancelled;
    mod complex_roots;
    mod dead_time;
    mod disguised;
    mod fast_algebra;
    mod fast_isolation;
    mod fuzz_corpus;
    mod margins;
    mod matrices;
    mod numbers;
    mod polynomials;
    mod real_roots;
    mod rightmost_roots;
    mod root_cases;
    mod stability;
    mod turning;
}

/// From a model's text to its characteristic polynomial, or to what is wrong with it.
mod models {
    mod closed_domains;
    mod constants_set;
    mod damaged;
    mod diagrams;
    mod drive;
    mod errors;
    mod expressions;
    mod nominal_formulas;
    mod root_causes;
}

/// Whole loops in one parameter, beyond what the corpus says of them.
mod loops {
    mod beside_constants;
    mod beside_functions;
    mod circles;
    mod clocks;
    mod corridor;
    mod dead_time;
    mod dead_time_margins;
    mod delay_requirements;
    mod delayed_requirements;
    mod drive;
    mod events_oracle;
    mod examples;
    mod held_margins;
    mod held_modes;
    mod held_pictures;
    mod held_requirements;
    mod impulses;
    mod large;
    mod least_margins;
    mod margin_ranges;
    mod margins;
    mod paper;
    mod peaks;
    mod pulsed_plant;
    mod pwm;
    mod pwm_oracle;
    pub(crate) mod rates;
    mod requirements;
    mod root_requirements;
    mod roots;
    mod roots_with_dead_time;
    mod sensitivity;
    mod square_roots;
    mod steady_duty;
}

/// Loops with complex coefficients, and plants that are held in another frame.
mod complex {
    mod dead_time;
    mod delayed_gains;
    mod delayed_margins;
    mod delayed_required_sets;
    mod frames;
    mod jury;
    mod laws;
    mod margin_laws;
    mod margins;
    pub(crate) mod oracle;
    mod random;
    mod required_sets;
    pub(crate) mod table;
}

/// Models with their expected answers in words, asked of every engine.
mod corpus {
    mod checkers;
    mod library;
    mod program;
}

/// Two parameters: the exact decomposition and boxes.
mod maps {
    mod body;
    mod body_program;
    mod boxes;
    mod cases;
    mod delayed_required;
    mod extents;
    mod for_all;
    mod held;
    mod laws;
    mod methods;
    mod oracle;
    mod program;
    mod required;
    mod required_boxes;
    mod samples;
}

/// Any number of parameters: boxes of tolerances.
mod tolerances {
    mod dead_time;
    mod degenerate;
    mod for_all;
    mod held;
    mod hostile;
    mod laws;
    mod moving;
    mod program;
    mod published;
    mod random_families;
    mod required;
    mod shares;
    mod singular;
    mod spiral;
}

/// Certificates: true ones are accepted by both checkers, wrong ones by none.
mod certificates {
    mod attacks;
    mod beside_constants;
    mod blocks;
    mod boxes;
    mod boxes_held;
    mod check;
    mod complex;
    mod coq;
    mod dead_time;
    mod for_all;
    mod gain;
    mod held;
    mod intervals_by_boxes;
    mod map_attacks;
    mod map_boxes;
    mod map_boxes_attacks;
    mod map_boxes_dead_time;
    mod maps;
    mod prewarp;
    mod program;
    mod rates;
    mod rates_held;
    mod readers;
    mod refused;
    mod roots_and_delays;
    mod smt;
    mod tuned;
}

/// What models are expected to be, and numbers that they take from other files.
mod expectations {
    mod claims;
    mod headers;
    mod locks;
}

/// Controllers as they are stored and run.
mod ship {
    mod bounds;
    mod cases;
    mod limits;
    mod roundings;
}

/// The best gains within what is required.
mod tune {
    mod campaign;
    mod cases;
    mod centre;
    mod delays;
    mod formulas;
    mod gains;
    mod laws;
    mod norms;
    mod robust;
    mod settling;
    mod told;
}

/// Responses and root loci in floating point, against exact answers.
mod simulation {
    mod linear;
    mod locus;
    mod switched;
}

/// Figures and the report on the paper.
mod pictures {
    mod figures;
    mod report;
}

/// Systems in files of other programs, made into models.
mod import;

/// The program as people and other programs see it.
mod program {
    mod bad_models;
    mod beginning;
    mod budgets;
    mod coverage;
    mod documents;
    mod drive;
    mod export;
    #[cfg(unix)]
    mod jury;
    mod one_line;
    mod outputs;
    mod regions;
    mod report;
    mod report_required;
    mod second_hour;
    mod simulate;
    mod sweep;
    mod undecided;
    mod usage;
    mod words;
}
