//! The report's tables for LaTeX: floats to be read by `\\input`, without any package.

use jurist_draw::page::Table;
use jurist_draw::page::words::{Token, is_variable, tokens};
use jurist_show::notation::latex_symbol;

/// Characters of a table's width at `\footnotesize` in a line of 12 cm.
const LINE: usize = 76;

/// Longer cells are broken into lines.
const LONG_CELL: usize = 20;

/// Floats for the tables, each with its label.
pub(super) fn floats(tables: &[(&str, &Table)]) -> String {
    let head = "% Tables about the drive, written by 'jurist paper --latex': \\input{tables} in a document.\n\
                % Limits called proved are exact, correctly rounded; those called drawn are floating point.\n";
    tables.iter().fold(head.to_owned(), |out, (label, table)| out + "\n" + &float(label, table))
}

fn float(label: &str, table: &Table) -> String {
    let columns = columns(table);
    let cell = |(cell, column): (&String, &Column)| match column {
        Column::Natural => text(cell),
        // Without the package array the end of a line has to be told apart from that of a row.
        Column::Share(_) => format!("\\raggedright {}", text(cell)),
    };
    let line = |row: &[String]| {
        let cells: Vec<String> = row.iter().zip(&columns).map(cell).collect();
        format!("{} \\tabularnewline\n", cells.join(" & "))
    };
    let widths: String = columns.iter().map(Column::to_string).collect();
    let many = columns.len() > MANY_COLUMNS;
    let style =
        if many { "\\scriptsize\\setlength{\\tabcolsep}{2pt}" } else { "\\footnotesize\\setlength{\\tabcolsep}{3pt}" };
    let body: String = table.rows.iter().map(|r| line(r)).collect();
    let head = if table.head.is_empty() { String::new() } else { line(&table.head) + "\\hline\n" };
    format!(
        "\\begin{{table}}[htbp]\n\\centering{style}\n\\caption{{{}}}\\label{{tab:{label}}}\n\
         \\begin{{tabular}}{{@{{}}{}@{{}}}}\n\\hline\n{head}{body}\\hline\n\\end{{tabular}}\n\\end{{table}}\n",
        text(&table.caption),
        widths
    )
}

/// Tables with more columns are set smaller.
const MANY_COLUMNS: usize = 4;

/// How wide a column is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// As wide as its longest cell.
    Natural,
    /// A share of the line, its cells broken into lines.
    Share(f64),
}

impl std::fmt::Display for Column {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Column::Natural => f.write_str("l"),
            Column::Share(share) => write!(f, "p{{{share:.2}\\linewidth}}"),
        }
    }
}

/// The columns of a table: those with long cells share what the others leave of the line, by length,
/// but each is as wide as its longest word.
fn columns(table: &Table) -> Vec<Column> {
    let count = table.head.len().max(table.rows.iter().map(Vec::len).max().unwrap_or(1));
    let cells = |k: usize| table.rows.iter().chain([&table.head]).filter_map(move |r| r.get(k));
    let length = |text: &str| text.chars().count();
    let sizes: Vec<(usize, usize)> = (0..count)
        .map(|k| {
            let longest = cells(k).map(|c| length(c)).max().unwrap_or(0);
            (longest, cells(k).flat_map(|c| c.split(' ')).map(length).max().unwrap_or(0))
        })
        .collect();
    let too_wide = sizes.iter().map(|(n, _)| n + 2).sum::<usize>() > LINE;
    let long = |(n, word): (usize, usize)| too_wide && n > LONG_CELL && 4 * word < 3 * n;
    let short: usize = sizes.iter().filter(|s| !long(**s)).map(|(n, _)| n + 2).sum();
    let room = LINE.saturating_sub(short).max(30) as f64;
    let in_long: usize = sizes.iter().filter(|s| long(**s)).map(|(n, _)| n).sum();
    let share = |(n, word): (usize, usize)| (room * n as f64 / in_long as f64).max(word as f64 + 1.0) / LINE as f64;
    sizes.iter().map(|s| if long(*s) { Column::Share(share(*s)) } else { Column::Natural }).collect()
}

/// Text with what LaTeX would take for commands escaped, and names set as mathematics.
fn text(plain: &str) -> String {
    let piece = |token: Token| match token {
        Token::Word(word) => match word.split_once('_') {
            Some((base, index)) if !base.is_empty() && !index.is_empty() => format!("${}$", latex_symbol(&word)),
            _ if is_variable(&word) => format!("${}$", latex_symbol(&word)),
            _ => word.replace('_', "\\_").replace('ω', "$\\omega$"),
        },
        Token::Number(digits, None) => digits,
        Token::Number(digits, Some(power)) => format!("${digits}\\cdot10^{{{power}}}$"),
        Token::Power(power) => format!("$^{{{power}}}$"),
        Token::Sign('-' | '−') => "$-$".to_owned(),
        Token::Sign('*' | '·') => "$\\,$".to_owned(),
        Token::Sign(c @ ('<' | '>' | '|')) => format!("${c}$"),
        Token::Sign(c @ ('_' | '%' | '&' | '#' | '$' | '{' | '}')) => format!("\\{c}"),
        Token::Sign('\\') => "\\textbackslash{}".to_owned(),
        Token::Sign('~') => "\\textasciitilde{}".to_owned(),
        Token::Sign(c) => c.to_string(),
    };
    tokens(plain).into_iter().map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_names_are_mathematics() {
        assert_eq!(text("K_pwm < 550"), "$K_{\\mathrm{pwm}}$ $<$ 550");
        assert_eq!(text("−10 % & T^2"), "$-$10 \\% \\& $T$$^{2}$");
        assert_eq!(text("3.26e-10"), "$3.26\\cdot10^{-10}$");
        assert_eq!(text("\\input{x}"), "\\textbackslash{}input\\{$x$\\}");
    }

    #[test]
    fn long_columns_share_the_line() {
        let mut table = Table::new("c", &["a", "b"]);
        table.rows.push(vec!["short".into(), "x".repeat(20)]);
        assert_eq!(columns(&table), [Column::Natural, Column::Natural]);
        table.rows.push(vec!["short".into(), "x ".repeat(100)]);
        assert!(matches!(columns(&table)[..], [Column::Natural, Column::Share(s)] if s > 0.85 && s < 0.93));
        assert_eq!(Column::Share(0.5).to_string(), "p{0.50\\linewidth}");
    }
}
