//! What is asked of a program that reads scripts.

/// A program that reads scripts. Function calls, lists and formulas are written the same in all of them, but for what is asked here.
pub(in crate::cli) trait Target: Sync {
    /// What it is called.
    fn words(&self) -> &'static str;

    /// Words that cannot be names in a script: keywords, and what scripts use.
    fn reserved(&self) -> [&'static [&'static str]; 2];

    /// What a comment begins with.
    fn comment(&self) -> &'static str;

    /// What ends a statement.
    fn end(&self) -> &'static str;

    /// What ends a line within parentheses.
    fn continued(&self) -> &'static str;

    /// The operator of powers.
    fn power(&self) -> &'static str;

    /// The operator of products of matrices.
    fn times(&self) -> &'static str;

    /// A matrix of these entries, which has rows and columns.
    fn matrix(&self, rows: &[Vec<String>]) -> String;

    /// A function that makes a matrix of numbers: `zeros`, `eye`.
    fn of_size(&self, function: &str, rows: usize, columns: usize) -> String;

    /// The step of a discrete loop without a sample time.
    fn unknown_step(&self) -> &'static str;

    /// What stands before all else; `uses` says whether the rest of the script uses a name.
    fn preamble(&self, uses: &dyn Fn(&str) -> bool) -> Vec<String>;

    /// Definitions of functions that the other program lacks.
    fn helpers(&self) -> &'static [(&'static str, &'static [&'static str])];

    /// How the poles are printed.
    fn print_poles(&self, is_polynomial: bool) -> Vec<String>;
}
