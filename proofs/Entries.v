(** The entries of a model as typed, and what is computed from them: fractions, the closed loop
    A - B K C, the characteristic polynomial. Integers and the standard library only. *)

From Coq Require Import ZArith List Bool QArith.
From Jurist Require Import Compute.
Import ListNotations.
Local Open Scope Z_scope.

(** ** Formulas in one parameter *)

Inductive expr :=
  | Num (q : Q) | Par
  | Plus (a b : expr) | Minus (a b : expr) | Times (a b : expr) | Over (a b : expr)
  | Neg (a : expr) | Power (a : expr) (n : nat).

Declare Scope expr_scope.
Delimit Scope expr_scope with expr.
Bind Scope expr_scope with expr.
Infix "+" := Plus : expr_scope.
Infix "-" := Minus : expr_scope.
Infix "*" := Times : expr_scope.
Infix "/" := Over : expr_scope.
Notation "- a" := (Neg a) : expr_scope.
Notation "a ^ n" := (Power a n%nat) : expr_scope.

(** Numbers as typed in a model: 46e-3 is 46/1000, exactly. *)
Definition Q_of_decimal (i : Decimal.signed_int) (f : Decimal.uint) (e : Z) : Q :=
  let m := Z.of_int (Decimal.app_int i f) in
  let k := e - Z.of_nat (Decimal.nb_digits f) in
  if 0 <=? k then Qmake (m * 10 ^ k) 1 else Qmake m (Z.to_pos (10 ^ (- k))).
Definition expr_of_number (n : Number.number) : option expr :=
  match n with
  | Number.Decimal (Decimal.Decimal i f) => Some (Num (Q_of_decimal i f 0))
  | Number.Decimal (Decimal.DecimalExp i f e) => Some (Num (Q_of_decimal i f (Z.of_int e)))
  | Number.Hexadecimal _ => None
  end.
Definition expr_to_number (e : expr) : option Number.number := None.
Number Notation expr expr_of_number expr_to_number : expr_scope.

(** ** Fractions of polynomials *)

Definition frac := (poly * poly)%type.

Definition fzero : frac := ([], [1]).

(** The same fraction without the common integer content, where the check succeeds. *)
Definition fnorm (f : frac) : frac :=
  let n := ptrim (fst f) in
  let d := ptrim (snd f) in
  match n with
  | [] => fzero
  | _ =>
      let g := Z.gcd (pcontent n) (pcontent d) in
      let n' := pquot n g in
      let d' := pquot d g in
      if (0 <? g) && peqb n (pscale g n') && peqb d (pscale g d') then (n', d') else (n, d)
  end.

(** A common multiple and the two cofactors, checked. *)
Definition common (a b : poly) : poly * poly * poly :=
  let q := pdiv b a in
  if peqb b (pmul a q) then (b, q, [1])
  else
    let q := pdiv a b in
    if peqb a (pmul b q) then (a, [1], q)
    else
      let g := Z.gcd (pcontent a) (pcontent b) in
      let x := pquot b g in
      let y := pquot a g in
      if peqb (pmul a x) (pmul b y) && peqb b (pscale g x) then (pmul a x, x, y) else (pmul a b, b, a).

Definition fadd (f g : frac) : frac :=
  let '(m, x, y) := common (snd f) (snd g) in
  fnorm (padd (pmul (fst f) x) (pmul (fst g) y), m).
Definition fopp (f : frac) : frac := (popp (fst f), snd f).
Definition fmul (f g : frac) : frac := fnorm (pmul (fst f) (fst g), pmul (snd f) (snd g)).
Definition fdiv (f g : frac) : frac := fnorm (pmul (fst f) (snd g), pmul (snd f) (fst g)).

Fixpoint fpow (f : frac) (n : nat) : frac :=
  match n with O => ([1], [1]) | S n' => fmul f (fpow f n') end.

Fixpoint normal (e : expr) : frac :=
  match e with
  | Num q => ([Qnum q], [Zpos (Qden q)])
  | Par => ([0; 1], [1])
  | Plus a b => fadd (normal a) (normal b)
  | Minus a b => fadd (normal a) (fopp (normal b))
  | Times a b => fmul (normal a) (normal b)
  | Over a b => fdiv (normal a) (normal b)
  | Neg a => fopp (normal a)
  | Power a n => fpow (normal a) n
  end.

(** What the formula divides by: none of these may be 0. *)
Fixpoint guards (e : expr) : list poly :=
  match e with
  | Num _ | Par => []
  | Plus a b | Minus a b | Times a b => guards a ++ guards b
  | Over a b => fst (normal b) :: guards a ++ guards b
  | Neg a | Power a _ => guards a
  end.

(** ** Matrices of formulas, by rows *)

Definition matrix := list (list expr).

Definition is_zero (e : expr) : bool := match e with Num q => Qnum q =? 0 | _ => false end.
Definition eadd (a b : expr) : expr := if is_zero a then b else if is_zero b then a else Plus a b.
Definition esub (a b : expr) : expr := if is_zero b then a else Minus a b.
Definition emul (a b : expr) : expr := if is_zero a || is_zero b then Num 0%Q else Times a b.

Definition entry (m : matrix) (i j : nat) : expr := nth j (nth i m []) (Num 0%Q).
Definition tabulate (r c : nat) (f : nat -> nat -> expr) : matrix :=
  map (fun i => map (f i) (seq 0 c)) (seq 0 r).

Definition mprod (r k c : nat) (a b : matrix) : matrix :=
  tabulate r c (fun i j => fold_right (fun l e => eadd (emul (entry a i l) (entry b l j)) e) (Num 0%Q) (seq 0 k)).
Definition msub (r c : nat) (a b : matrix) : matrix :=
  tabulate r c (fun i j => esub (entry a i j) (entry b i j)).

(** A - B K C, with [n] states, [m] inputs of the plant and [q] outputs fed back. *)
Definition feedback (n m q : nat) (A B K C : matrix) : matrix :=
  msub n n A (mprod n q n (mprod n m q B K) C).

(** ** The characteristic polynomial

    Row i of z I - A times a common denominator of that row, and the determinant by its first row. *)

Definition row_den (r : list frac) : poly := fold_right (fun f d => fst (fst (common (snd f) d))) [1] r.

Definition char_entry (i j : nat) (d : poly) (f : frac) : bipoly :=
  let n := popp (pmul (fst f) (pdiv d (snd f))) in
  if Nat.eqb i j then [n; d] else [n].

Definition char_row (n i : nat) (r : list frac) : list bipoly :=
  let d := row_den r in map (fun j => char_entry i j d (nth j r fzero)) (seq 0 n).

Definition char_row_ok (r : list frac) : bool :=
  let d := row_den r in forallb (fun f => peqb d (pmul (snd f) (pdiv d (snd f)))) r.

Fixpoint drop_nth {A : Type} (j : nat) (l : list A) : list A :=
  match l, j with [], _ => [] | _ :: l', O => l' | a :: l', S j' => a :: drop_nth j' l' end.

Fixpoint alternate (l : list bipoly) : bipoly :=
  match l with [] => [] | x :: l' => badd x (bopp (alternate l')) end.

Fixpoint det (n : nat) (rows : list (list bipoly)) : bipoly :=
  match n with
  | O => [[1]]
  | S n' =>
      let r := hd [] rows in
      alternate (map (fun j => let x := nth j r [] in
                               if bzero x then [] else bmul x (det n' (map (drop_nth j) (tl rows)))) (seq 0 n))
  end.

Definition fractions (n : nat) (m : matrix) : list (list frac) :=
  map (fun i => map (fun j => normal (entry m i j)) (seq 0 n)) (seq 0 n).

Definition matrix_guards (n : nat) (m : matrix) : list poly :=
  flat_map (fun i => flat_map (fun j => guards (entry m i j)) (seq 0 n)) (seq 0 n) ++ map row_den (fractions n m).

Definition charpoly (n : nat) (m : matrix) : bipoly :=
  det n (map (fun i => char_row n i (nth i (fractions n m) [])) (seq 0 n)).

(** Different from 0 on the whole domain; the whole line is looked at in two halves. *)
Definition nonzero_over (fuel : nat) (a b : option Q) (p : poly) : bool :=
  match ptrim p with
  | [c] => negb (0 =? c)
  | _ =>
      match a, b with
      | None, None =>
          nonzero_on fuel (-1, 0) (0, 1) p && negb (0 =? pval 0 p) && nonzero_on fuel (0, 1) (1, 0) p
      | _, _ => nonzero_on fuel (low_pt a) (high_pt b) p
      end
  end.

Definition all_nonzero (fuel : nat) (ans : answer) (gs : list poly) : bool :=
  forallb (nonzero_over fuel (lower ans) (upper ans)) gs.

Definition check_matrix (fuel : nat) (r : region) (n : nat) (m : matrix) (ans : answer) : bool :=
  all_nonzero fuel ans (matrix_guards n m) && forallb char_row_ok (fractions n m) &&
  Nat.eqb (length (charpoly n m)) (S n) && check_poly fuel r (charpoly n m) ans.

(** ** A polynomial given by its coefficients, lowest power first *)

Definition coefs (l : list expr) : list frac := map normal l.
Definition cleared (l : list frac) : bipoly :=
  let d := row_den l in map (fun f => pmul (fst f) (pdiv d (snd f))) l.

Definition check_coefs (fuel : nat) (r : region) (l : list expr) (ans : answer) : bool :=
  let fs := coefs l in
  all_nonzero fuel ans (flat_map guards l ++ [row_den fs]) && char_row_ok fs && check_poly fuel r (cleared fs) ans.

(** ** One point *)

Definition point_matrix_ok (r : region) (n : nat) (m : matrix) : bool :=
  point_nonzero (matrix_guards n m) && forallb char_row_ok (fractions n m) &&
  Nat.eqb (length (charpoly n m)) (S n) && region_ok r.
Definition check_matrix_point (r : region) (n : nat) (m : matrix) (stable : bool) : bool :=
  point_matrix_ok r n m && Bool.eqb (point_in r n (charpoly n m)) stable.

Definition point_coefs_ok (r : region) (l : list expr) : bool :=
  let fs := coefs l in
  point_nonzero (flat_map guards l ++ [row_den fs]) && char_row_ok fs && region_ok r &&
  Nat.eqb (length l) (S (pred (length l))).
Definition check_coefs_point (r : region) (l : list expr) (stable : bool) : bool :=
  point_coefs_ok r l && Bool.eqb (point_in r (pred (length l)) (cleared (coefs l))) stable.
