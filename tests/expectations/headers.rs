//! `from = "params.h#NAME"`: numbers of headers, YAML and JSON.

use crate::helpers::folder::Folder;
use serde_json::Value;

const MODEL: &str = "time = 'discrete'\n[constants]\nk = { from = 'params.h#KP', unit = 'V' }\n[parameters]\nK = 1\n[loop]\n\
    characteristic = 'z - 1 + k*K'\n";

/// The number that the program takes from a header, or the first sentence of why it takes none.
fn read(header: &str) -> Result<String, String> {
    let folder = Folder::new(&[("loop.toml", MODEL), ("params.h", header)]);
    let run = folder.jurist(&["check", "loop.toml", "--resolved", "whole.toml"]);
    match run.status {
        0 => {
            let text = folder.read("whole.toml");
            let value = text.split("value = \"").nth(1).unwrap().split('"').next().unwrap().to_owned();
            assert!(text.contains("unit = 'V'") && text.contains("SHA-256 of the file "), "{text}");
            Ok(value)
        }
        2 => {
            assert!(
                run.stderr.contains("error[E-from]") && run.stderr.contains("loop.toml:3:"),
                "{header}: {}",
                run.stderr
            );
            Err(run.stderr)
        }
        other => panic!("{header}: {other}: {}", run.stderr),
    }
}

const TENTH: &str = "0.1000000000000000055511151231257827021181583404541015625";
const TENTH_SINGLE: &str = "0.100000001490116119384765625";

#[test]
fn one_literal_is_read_as_a_compiler_reads_it() {
    for (header, value) in [
        ("#define KP 2\n", "2"),
        ("#define KP 0.1f", TENTH_SINGLE),
        ("#define KP 0.1\n", TENTH),
        ("#define KP (-0.5)\n", "-0.5"),
        ("  #  define   KP\t( 0.5F ) /* half */\n", "0.5"),
        ("#define KP 0.5 // half, not 0.25\n", "0.5"),
        ("#define KP \\\n  0.5\n", "0.5"),
        ("#define KP \\\r\n  0.5\r\n", "0.5"),
        ("/* #define KP 1 */\r\n#define KP 0.5\r\n", "0.5"),
        ("// #define KP 1 \\\n#define KP 2\n#define KP 0.5\n", "0.5"),
        ("#define KP_MAX 3\n#define KP 0.5\n#define XKP 4\n", "0.5"),
        ("#define KP 0x10\n", "16"),
        ("#define KP 10UL\n", "10"),
        ("#define KP 1'000.5\n", "1000.5"),
        ("#define KP 0.5\n#define KP 0.5\n", "0.5"),
        ("#define KP -0x7fffffff\n", "-2147483647"),
        ("const unsigned char KP = 255;\n", "255"),
        ("const int64_t KP = -5000000000;\n", "-5000000000"),
        ("const float KP = 0.1f;\n", TENTH_SINGLE),
        ("const float KP = 0.1;\n", TENTH_SINGLE),
        ("static const double KP = 0.1;\n", TENTH),
        ("const double KP = 0.1f;\n", TENTH_SINGLE),
        ("static constexpr float32_t KP = (0.5f); int x;\n", "0.5"),
        ("int KP2 = 3; const int KP = 7;\n", "7"),
        ("const char *s = \"#define KP 3; const int KP = 4;\"; const int KP = 7;\n", "7"),
        ("const float\n  KP\n  = 0.5f\n;\n", "0.5"),
        ("namespace pid {\n inline constexpr double KP = 0.5;\n}\n", "0.5"),
        ("#ifndef P_H\n#define P_H\n#define KP 0.5\n#endif\n", "0.5"),
        ("#ifndef KP\n#define KP 0.5\n#endif\n", "0.5"),
        ("#if 0\n#define KP 1\n#else\n#define KP 0.5\n#endif\n", "0.5"),
        ("#if 1\n#define KP 0.5\n#else\n#define KP 1\n#endif\n", "0.5"),
        (
            "#ifndef P_H\n#define P_H\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n#define KP 0.5\nstatic const int N = 3;\n\
             #ifdef __cplusplus\n}\n#endif\n#endif\n",
            "0.5",
        ),
        ("#if 1\nconst float KP = 0.5f;\n#else\nconst float KP = 1.0f;\n#endif\n", "0.5"),
        ("#if 0\nconst float KP = 1.0f;\n#endif\nconst float KP = 0.5f;\n", "0.5"),
        ("\u{feff}#define KP 0.5\n", "0.5"),
        ("static constexpr auto KP = 9007199254740993;\n", "9.007199254740993e15"),
        ("// a \\ \n#define KP 1\n#define KP 0.5\n", "0.5"),
        ("const char *s = \"a\\\r\n#define KP 1\r\n\";\r\n#define KP 0.5\r\n", "0.5"),
        ("char c = '\"'; /*\n#define KP 1\n*/\n#define KP 0.5\n", "0.5"),
        ("int f(void) { return 1'000; }\n#define KP 0.5\n", "0.5"),
        ("#pragma once\n#include \"x.h\"\n#define KP 0.5\n", "0.5"),
    ] {
        assert_eq!(read(header).as_deref(), Ok(value), "{header}");
    }
}

#[test]
fn everything_else_is_refused_with_its_line() {
    for (header, why) in [
        ("", "there is no '#define KP'"),
        ("#define KP2 1\n", "there is no '#define KP'"),
        ("#define SPEED_LIMIT 1\n#define KPP 2\n", "did you mean 'KPP'?"),
        ("\n#define KP (1 + 2)\n", "params.h, line 2"),
        ("#define KP (float)1.5\n", "casts"),
        ("#define KP ((float)1.5)\n", "casts"),
        ("#define KP GAIN\n#define GAIN 2\n", "'GAIN' is another name"),
        ("#define KP (GAIN)\n", "'GAIN' is another name"),
        ("#define KP SCALE(2)\n", "not one literal"),
        ("#define KP(x) 2\n", "a macro with arguments"),
        ("#define KP\n", "there is no number"),
        ("#define KP 010\n", "octal"),
        ("#define KP 1.5L\n", "long double"),
        ("#define KP 1e39f\n", "infinite"),
        ("#define KP 1e309\n", "infinite"),
        ("#define KP 1.5 2\n", "not one literal"),
        ("#define KP 1,5\n", "not one literal"),
        ("#define KP 1\n#define KP 2\n", "line 1 and again on line 2, differently"),
        ("#define KP 1\nconst int KP = 1;\n", "differently"),
        ("#define KP 1\n#undef KP\n", "#undef"),
        ("#ifdef FAST\n#define KP 1\n#endif\n", "under a condition"),
        ("#if VERSION > 2\n#define KP 1\n#else\n#define KP 2\n#endif\n", "under a condition"),
        ("#if 0\n#define KP 1\n#endif\n", "there is no '#define KP'"),
        ("#ifdef FAST\nconst int KP = 1;\n#endif\n", "under a condition"),
        ("#if 1\n#elif A\n#else\n#define KP 2\n#endif\n", "there is no '#define KP'"),
        ("#if 0\n#elifdef A\n#define KP 2\n#else\n#define KP 3\n#endif\n", "under a condition"),
        ("#if 1\n#elifdef A\n#define KP 2\n#endif\n", "there is no '#define KP'"),
        ("#ifndef V\n#define V\n#define KP 1\n#else\n#define KP 2\n#endif\n", "under a condition"),
        ("#ifndef P_H\n#define P_H\n#endif\n#ifndef P_H\n#define KP 1\n#endif\n", "under a condition"),
        ("#define KP 1\n%:undef KP\n", "with '#' alone"),
        ("const char *s = R\"(\n#define KP 1\n)\";\n", "not read here"),
        ("/\\\n*\n#define KP 1\n*/\n", "not read here"),
        ("void f(void) { const float KP = 1.0f; }\n", "a function or a class"),
        ("__attribute__((section(\".cal\"))) const float KP = 1.0f;\n", "in a form that is not read"),
        ("typedef float integ_t; const integ_t KP = 1;\n", "'integ_t' is not known"),
        ("float KP = 1.5f;\n", "is a variable"),
        ("extern const float KP;\n", "there is no '#define KP'"),
        ("const float KP[2] = {1, 2};\n", "not a single number"),
        ("const my_t KP = 1.5f;\n", "'my_t' is not known"),
        ("const int KP = 1.5;\n", "cuts off the fraction"),
        ("#define KP -1u\n", "wraps"),
        ("#define KP (-0x90000000)\n", "wraps"),
        ("const float KP = -1UL;\n", "wraps"),
        ("#define KP 99999999999999999999\n", "larger than any integer"),
        ("const int KP = 5000000000;\n", "may not fit"),
        ("const char KP = -1;\n", "may not fit"),
        ("const uint8_t KP = 256;\n", "may not fit"),
        ("const float KP = 2*1.5f;\n", "not one literal"),
        ("const long double KP = 1.5;\n", "long double"),
        ("enum { KP = 3 };\n", "KP"),
        ("#define KP \"1\"\n", "not one literal"),
        ("#define KP é\n", "another name"),
    ] {
        let refused = read(header).unwrap_err();
        assert!(refused.contains(why), "{header}: {refused}");
    }
}

#[test]
fn decimals_are_taken_as_they_are_written_where_that_is_asked_for() {
    for (from, value) in [
        ("{ from = 'params.h#KP', as = 'decimal' }", "value = \"0.1\" }"),
        ("{ as = 'decimal', from = 'params.h#KP' }", "{ value = \"0.1\" }"),
        ("{ as = 'decimal', unit = 'V', from = 'params.h#KP' }", "{ unit = 'V', value = \"0.1\" }"),
        ("{ from = 'gains.yaml#speed.kp' }", "value = \"0.3\" }"),
        ("{ from = 'sub/gains.json#/speed/kp' }", "value = \"0.25\" }"),
    ] {
        let model = MODEL.replace("{ from = 'params.h#KP', unit = 'V' }", from);
        let folder = Folder::new(&[
            ("loop.toml", &model),
            ("params.h", "#define KP 0.1f\n"),
            ("gains.yaml", "speed:\n  kp: 0.30\n"),
            ("sub/gains.json", "{\"speed\": {\"kp\": 2.5e-1}}"),
        ]);
        let run = folder.jurist(&["check", "loop.toml", "--resolved", "whole.toml"]);
        assert_eq!(run.status, 0, "{from}: {}", run.stderr);
        let text = folder.read("whole.toml");
        assert!(text.contains(value), "{from}: {text}");
        // What was written is a model of its own, of the same answer.
        let answers =
            ["loop.toml", "whole.toml"].map(|m| folder.jurist(&["intervals", m, "--param", "K", "-q"]).stdout);
        assert_eq!(answers[0], answers[1]);
        assert!(answers[0].contains("< K <"), "{}", answers[0]);
    }
}

#[test]
fn files_outside_of_the_folder_are_not_read() {
    let folder = Folder::new(&[("in/params.h", "#define KP 1\n"), ("params.h", "#define KP 1\n")]);
    for path in ["../params.h", "/etc/hostname.h", "sub/../../params.h", "missing.h", ".", "params.txt", "a\\\\b.h"] {
        folder.write("in/loop.toml", &MODEL.replace("'params.h#KP'", &format!("\"{path}#KP\"")));
        let run = folder.jurist(&["check", "in/loop.toml"]);
        assert_eq!(run.status, 2, "{path}");
        assert!(run.stderr.contains("E-from"), "{path}: {}", run.stderr);
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path("params.h"), folder.path("in/link.h")).unwrap();
        folder.write("in/loop.toml", &MODEL.replace("params.h", "link.h"));
        assert!(folder.jurist(&["check", "in/loop.toml"]).stderr.contains("by a link"));
    }
    // Standard input has the folder of the program.
    folder.write("in/loop.toml", MODEL);
    assert_eq!(folder.jurist(&["check", "in/loop.toml"]).status, 0);
}

#[test]
fn a_reference_that_makes_no_sense_is_refused_where_it_stands() {
    for (entry, code) in [
        ("{ from = 'params.h' }", "E-from"),
        ("{ from = '#KP' }", "E-from"),
        ("{ from = 1 }", "E-from"),
        ("{ from = 'params.h#KP', value = 1 }", "E-two-forms"),
        ("{ from = 'params.h#KP', as = 'float' }", "E-value"),
        ("{ value = 1, as = 'decimal' }", "E-from"),
    ] {
        let model = MODEL.replace("{ from = 'params.h#KP', unit = 'V' }", entry);
        let folder = Folder::new(&[("loop.toml", &model), ("params.h", "#define KP 1\n")]);
        let run = folder.jurist(&["check", "loop.toml", "--json"]);
        let document: Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(document["diagnostics"][0]["code"], code, "{entry}: {document}");
        assert_eq!(document["diagnostics"][0]["place"]["line"], 3, "{entry}");
    }
}

/// A certificate is about a text with numbers; both checkers refuse one that refers to others.
#[test]
fn certificates_go_with_the_model_that_holds_the_numbers() {
    let folder = Folder::new(&[("loop.toml", MODEL), ("params.h", "#define KP 0.1f\n")]);
    let run = folder.jurist(&["intervals", "loop.toml", "--param", "K", "--certificate", "k.json"]);
    assert_eq!(run.status, 2, "{}", run.stdout);
    assert!(run.stderr.contains("add --resolved FILE"), "{}", run.stderr);
    let options = ["--param", "K", "--certificate", "k.json", "--resolved", "whole.toml"];
    let run = folder.jurist(&[&["intervals", "loop.toml"], &options[..]].concat());
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("k = 0.100000001490 (params.h#KP, line 1: 0.1f as float32)"), "{}", run.stderr);
    let verified = folder.jurist(&["verify", "whole.toml", "k.json"]);
    assert_eq!(verified.status, 0, "{}", verified.stderr);
    assert!(!verified.stdout.contains("another text"), "{}", verified.stdout);
    let verified = folder.jurist(&["verify", "loop.toml", "k.json"]);
    assert!(
        verified.status == 4 && verified.stderr.contains("the copy that '--resolved FILE' wrote"),
        "{}",
        verified.stderr
    );
    let run = folder.jurist(&["intervals", "loop.toml", "--param", "K", "--resolved", "loop.toml"]);
    assert_eq!(run.status, 2);
    assert_eq!(folder.read("loop.toml"), MODEL);
}
