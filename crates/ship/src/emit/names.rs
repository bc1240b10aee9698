//! Names that are legal in every language: one controller has the same names in all of them.

use std::collections::BTreeSet;

/// Words that some language keeps for itself, or that the text uses, in small letters: structured text does not tell them from large ones.
const RESERVED: &str = "
    s v self reset h state init step new
    auto break case char const continue default do double else enum extern float for goto if inline int long register restrict return short
    signed sizeof static struct switch typedef union unsigned void volatile while asm bool complex imaginary null true false linux unix errno
    class delete friend namespace operator private protected public template this throw using virtual try catch explicit export typename and
    or not xor mutable alignas alignof constexpr decltype noexcept nullptr thread_local
    as async await box crate dyn fn impl in let loop match mod move mut pub ref static_assert super trait type unsafe use where abstract
    become final gen macro override priv typeof unsized yield i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize f32 f64 str
    abs acos action add any any_bit any_date any_int any_num any_real array asin at atan begin bit bcd by byte cal calc calcn concat
    configuration constant cos cu cd ct ctd ctu ctud cv d date date_and_time dint div dt dword elsif end_action end_case end_configuration
    end_for end_function end_function_block end_if end_program end_repeat end_resource end_step end_struct end_transition end_type end_var
    end_while en eno eq et exit exp expt f_edge f_trig find from function function_block ge gt initial_step insert interval jmp jmpc jmpcn
    l ld ldn le left len limit lint ln log lreal lt lword max mid min mod mul mux n ne neg of on orn p program pt pv q1 qd qu r r1 r_edge
    r_trig read_only read_write real release repeat replace resource ret retain retc retcn right rol ror rs rtc s1 sd sel sema shl shr sin
    single sint sl sqrt sr st stn string sub sema tan task then time time_of_day to tod tof ton tp transition trunc udint uint ulint until
    usint var var_access var_config var_external var_global var_in_out var_input var_output var_temp with word wstring xorn
    non_retain overlap method end_method interface end_interface extends implements property abs_real ref_to lower_bound upper_bound
";

fn is_reserved(name: &str) -> bool {
    RESERVED.split_whitespace().any(|word| word == name)
}

/// ASCII letters, digits and single underscores between them, a letter first.
fn plain(name: &str) -> String {
    /// Longer names are cut.
    const LONGEST: usize = 48;
    let letters: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let parts: Vec<&str> = letters.split('_').filter(|part| !part.is_empty()).collect();
    let joined = parts.join("_");
    let starts = joined.starts_with(|c: char| c.is_ascii_alphabetic());
    let joined = if starts { joined } else { format!("x_{joined}") };
    joined[..joined.len().min(LONGEST)].trim_end_matches('_').to_owned()
}

/// The name of a controller.
///
/// Cost: linear in the name.
pub(super) fn legal(name: &str) -> String {
    let plain = plain(name);
    match plain.as_str() {
        "x" => "controller".into(),
        _ if is_reserved(&plain.to_ascii_lowercase()) => format!("{plain}_controller"),
        _ => plain,
    }
}

/// Names within a controller that are taken.
pub(super) struct Names {
    /// What names of functions begin with.
    prefix: String,
    used: BTreeSet<String>,
}

impl Names {
    /// None but the controller's.
    pub fn of(controller: &str) -> Names {
        let name = controller.to_ascii_lowercase();
        Names { prefix: format!("{name}_"), used: BTreeSet::from([name]) }
    }

    /// The first name that is free, in small letters: the plain one, or with a number behind it.
    ///
    /// Cost: linear in the names before that are alike.
    pub fn free(&mut self, name: &str) -> String {
        let plain = plain(name).to_ascii_lowercase();
        let plain = if plain.starts_with(&self.prefix) { format!("x_{plain}") } else { plain };
        let more = (2..).map(|k| format!("{plain}_{k}"));
        let mut all = std::iter::once(plain.clone()).chain(more);
        let is_free = |name: &String| !is_reserved(name) && !self.used.contains(name);
        let found = all.find(is_free).expect("there is no end of names");
        self.used.insert(found.clone());
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_text_becomes_a_name() {
        let cases = [
            ("pi", "pi"),
            ("PI", "PI"),
            ("speed controller", "speed_controller"),
            ("__2nd  loop__", "x_2nd_loop"),
            ("while", "while_controller"),
            ("Self", "Self_controller"),
            ("", "controller"),
            ("*/ (*", "controller"),
            ("größe", "gr_e"),
        ];
        for (name, expected) in cases {
            assert_eq!(legal(name), expected, "{name}");
        }
    }

    #[test]
    fn names_differ_where_large_letters_are_small_ones() {
        let mut names = Names::of("PI");
        let found = ["y", "Y", "y_2", "if", "pi", "PI_fit", "s", "fn"].map(|name| names.free(name));
        assert_eq!(found, ["y", "y_2", "y_2_2", "if_2", "pi_2", "x_pi_fit", "s_2", "fn_2"]);
    }

    #[test]
    fn no_name_has_two_underscores_in_a_row_or_one_at_its_end() {
        let name = legal(&"a_".repeat(80));
        assert!(name.len() <= 48 && !name.contains("__") && !name.ends_with('_'), "{name}");
    }
}
