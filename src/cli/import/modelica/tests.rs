//! Both shapes of the file, and places of mistakes.

use super::{Shape, read};

/// In the shape of OpenModelica from 1.16 on.
const NEW: &str = "model linearized_model \"Servo.Drive\"\n  parameter Integer n = 2 \"number of states\";\n  parameter Integer m = 1 \"number of inputs\";\n  parameter Integer p = 1 \"number of outputs\";\n\n  parameter Real x0[n] = {0, 1.5};\n  parameter Real u0[m] = {0};\n\n  parameter Real A[n, n] =\n\t[-21.73913043478261, -1.195652173913043e-05;\n\t5.91, 0];\n\n  parameter Real B[n, m] =\n\t[21.7;\n\t0];\n\n  parameter Real C[p, n] =\n\t[0, 1];\n\n  parameter Real D[p, m] = zeros(p, m);\n\n\n  Real x[n](start=x0);\n  input Real u[m](start=u0);\n  output Real y[p];\n\n  Real 'x_motor.i' = x[1];\n  Real 'x_motor.w' = x[2];\n  Real 'u_voltage' = u[1];\n  Real 'y_speed' = y[1];\nequation\n  der(x) = A * x + B * u;\n  y = C * x + D * u;\nend linearized_model;\n";

/// In the shape before.
const OLD: &str = "model linear_Servo_Drive\n  parameter Integer n = 2; // states\n  parameter Integer k = 1; // top-level inputs\n  parameter Integer l = 1; // top-level outputs\n  parameter Real x0[2] = {0,1.5};\n  parameter Real u0[1] = {0};\n  parameter Real A[2,2] = [-21.73913043478261,-1.195652173913043e-05;5.91,0];\n  parameter Real B[2,1] = [21.7;0];\n  parameter Real C[1,2] = [0,1];\n  parameter Real D[1,1] = [0];\n  Real x[2](start=x0);\n  input Real u[1](start= u0);\n  output Real y[1];\n\n  Real 'x_motor.i' = x[1];\n  Real 'x_motor.w' = x[2];\n  Real 'u_voltage' = u[1];\n  Real 'y_speed' = y[1];\n\nequation\n  der(x) = A * x + B * u;\n  y = C * x + D * u;\nend linear_Servo_Drive;\n";

#[test]
fn both_shapes_of_the_file() {
    for text in [NEW, OLD] {
        for text in [text.to_owned(), text.replace('\n', "\r\n"), format!("\u{feff}{text}")] {
            let found = read(&text).unwrap();
            let matrices: Vec<_> = found.list.iter().map(|v| (v.name.as_str(), v.shape)).collect();
            let expected = [("A", 2, 2), ("B", 2, 1), ("C", 1, 2), ("D", 1, 1)];
            assert_eq!(matrices, expected.map(|(name, rows, columns)| (name, Shape::Matrix(rows, columns))));
            let entries: Vec<String> = found.list[0].entries.iter().map(ToString::to_string).collect();
            assert_eq!(entries, ["-21.73913043478261", "-0.00001195652173913043", "5.91", "0"]);
            assert_eq!(found.names.states, ["motor.i", "motor.w"]);
            assert_eq!(
                (found.names.inputs.as_slice(), found.names.outputs.as_slice()),
                (&["voltage".to_owned()][..], &["speed".to_owned()][..])
            );
        }
    }
    assert_eq!(read(NEW).unwrap().names.title.as_deref(), Some("Servo.Drive"));
    assert_eq!(read(OLD).unwrap().names.title.as_deref(), Some("Servo_Drive"));
}

#[test]
fn arrays_of_arrays_and_no_inputs() {
    let text = NEW.replace("[0, 1]", "{{0, 1}}").replace("[21.7;\n\t0]", "{{21.7}, {-0}}");
    let found = read(&text).unwrap();
    assert_eq!(
        found.list,
        read(NEW)
            .unwrap()
            .list
            .iter()
            .zip(&found.list)
            .map(|(a, b)| super::Variable { span: b.span, ..a.clone() })
            .collect::<Vec<_>>()
    );
    let none = NEW.replace("m = 1", "m = 0").replace("[21.7;\n\t0]", "zeros(n, m)");
    assert_eq!(read(&none).unwrap().list[1].shape, Shape::Matrix(2, 0));
}

#[test]
fn mistakes_have_their_places() {
    let place = |old: &str, new: &str| {
        let text = NEW.replace(old, new);
        let error = read(&text).unwrap_err();
        let span = error.primary.unwrap().span;
        (text[span.start..span.end].to_owned(), error.message)
    };
    assert_eq!(
        place("5.91", "-nan"),
        ("-nan".to_owned(), "row 2, column 1 of A is -nan: not a finite number".to_owned())
    );
    assert_eq!(
        place("5.91, 0", "5.91"),
        (
            "[-21.73913043478261, -1.195652173913043e-05;\n\t5.91]".to_owned(),
            "A is declared 2 by 2, but row 2 has 1 numbers".to_owned()
        )
    );
    assert_eq!(place("n = 2", "n = 1000000").0, "1000000");
    assert_eq!(place("5.91", "k*2").0, "k");
    assert_eq!(place("5.91", "").1, "row 2, column 1 of A is ',', which is no real decimal number");
    assert_eq!(place("A[n, n]", "A[n, q]").0, "q");
    assert_eq!(place("\"number of states\"", "\"number").1, "a text in quotes does not end");
    assert!(read("model M end M;").is_err() && read("").is_err());
    let cut = &NEW[..NEW.find("5.91").unwrap()];
    assert!(read(cut).is_err());
}
