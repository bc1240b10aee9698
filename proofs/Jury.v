(** Jury's criterion, in both directions and for every order.

    [stable n p] says that the real polynomial [p] has degree [n] and that all its roots lie strictly
    inside the unit circle. [jury n p] is the criterion: each row of Jury's table has a first entry
    smaller in absolute value than its last one. *)

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mathcomp Require Import ring.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Jury.
Variable R : rcfType.
Local Notation C := R[i].
Implicit Types (p q : {poly R}) (z w : C) (n k : nat).

(** A real polynomial read as one with complex coefficients. *)
Definition cpoly p : {poly C} := map_poly (real_complex R) p.

(** Degree [n] (it does not lose its degree), and every root inside the unit circle. *)
Definition stable n p : Prop :=
  [/\ (size p <= n.+1)%N, p`_n != 0 & forall z, root (cpoly p) z -> `|z| < 1].

(** The next row of the table: from degree [n] to degree [n - 1]. *)
Definition row n p : {poly R} := \poly_(k < n) (p`_n * p`_k.+1 - p`_0 * p`_(n - k.+1)).

(** The criterion, row by row; a row of degree 0 has only to be different from 0. *)
Fixpoint jury n p : Prop :=
  if n is n'.+1 then p`_0 ^+ 2 < p`_n ^+ 2 /\ jury n' (row n p) else p`_0 != 0.

(** The coefficients in the opposite order: [z ^ n * p (1 / z)]. *)
Definition rev_poly n p : {poly R} := \poly_(i < n.+1) p`_(n - i).

Lemma coef_rev n p i : (rev_poly n p)`_i = if (i <= n)%N then p`_(n - i) else 0.
Proof. by rewrite coef_poly ltnS. Qed.

Lemma coef_row n p k :
  (row n p)`_k = if (k < n)%N then p`_n * p`_k.+1 - p`_0 * p`_(n - k.+1) else 0.
Proof. by rewrite coef_poly. Qed.

Lemma size_row n p : (size (row n p) <= n)%N.
Proof. exact: size_poly. Qed.

Lemma coef_big n p k : (size p <= n.+1)%N -> (n < k)%N -> p`_k = 0.
Proof. by move=> sp nk; rewrite nth_default // (leq_trans sp). Qed.

Lemma lead_row n p : (row n.+1 p)`_n = p`_n.+1 ^+ 2 - p`_0 ^+ 2.
Proof. by rewrite coef_row ltnSn subnn !expr2. Qed.

Lemma rowE n p : (size p <= n.+2)%N ->
  'X * row n.+1 p = p`_n.+1 *: p - p`_0 *: rev_poly n.+1 p.
Proof.
move=> sp; apply/polyP => k; rewrite coefXM coefB !coefZ coef_rev.
case: k => [|k] /=; first by rewrite subn0 mulrC subrr.
rewrite coef_row ltnS; case: leqP => // kn.
by rewrite (@coef_big _ _ k.+1 sp) // !mulr0 subrr.
Qed.

Lemma rev_rowE n p : (size p <= n.+2)%N ->
  rev_poly n (row n.+1 p) = p`_n.+1 *: rev_poly n.+1 p - p`_0 *: p.
Proof.
move=> sp; apply/polyP => k; rewrite coefB !coefZ !coef_rev coef_row.
case: (leqP k n) => kn.
  by rewrite ltnS leq_subr (leqW kn) subSS subKn // subSn.
case: (leqP k n.+1) => kn1; last by rewrite (@coef_big _ _ k sp) // !mulr0 subrr.
have -> : k = n.+1 by apply/eqP; rewrite eqn_leq kn1.
by rewrite subnn mulrC subrr.
Qed.

Lemma row_inv n p : (size p <= n.+2)%N ->
  (p`_n.+1 ^+ 2 - p`_0 ^+ 2) *: p
  = p`_n.+1 *: ('X * row n.+1 p) + p`_0 *: rev_poly n (row n.+1 p).
Proof.
move=> sp; rewrite rowE // rev_rowE // -!mul_polyC; move: (rev_poly _ _) => q.
by rewrite polyCB !polyC_exp; ring.
Qed.

(** ** Values *)

Lemma cpolyZ a p : cpoly (a *: p) = a%:C%C *: cpoly p.
Proof. exact: map_polyZ. Qed.

Lemma cpolyD p q : cpoly (p + q) = cpoly p + cpoly q.
Proof. exact: rmorphD. Qed.

Lemma cpolyB p q : cpoly (p - q) = cpoly p - cpoly q.
Proof. exact: rmorphB. Qed.

Lemma cpolyXM p : cpoly ('X * p) = 'X * cpoly p.
Proof. by rewrite /cpoly rmorphM /= map_polyX. Qed.

Lemma coef_cpoly p i : (cpoly p)`_i = (p`_i)%:C%C.
Proof. exact: coef_map. Qed.

Lemma size_cpoly p : size (cpoly p) = size p.
Proof. exact: size_map_poly. Qed.

Lemma norm_real (a : R) : `|a%:C%C| = `|a|%:C%C :> C.
Proof. by rewrite normc_def /= expr0n addr0 sqrtr_sqr. Qed.

Lemma conj_real (a : R) : (a%:C%C : C)^* = a%:C%C.
Proof. by apply/CrealP; rewrite complex_real. Qed.

Lemma conj_cpoly p z : (cpoly p).[z^*] = (cpoly p).[z]^*.
Proof.
rewrite !horner_coef !size_cpoly rmorph_sum; apply: eq_bigr => i _.
by rewrite rmorphM rmorphX coef_cpoly conj_real.
Qed.

Lemma horner_rev n p z : (size p <= n.+1)%N -> z != 0 ->
  (cpoly (rev_poly n p)).[z] = z ^+ n * (cpoly p).[z^-1].
Proof.
move=> sp z0; rewrite (@horner_coef_wide _ n.+1) ?size_cpoly ?size_poly //.
rewrite (@horner_coef_wide _ n.+1 (cpoly p)) ?size_cpoly // mulr_sumr.
rewrite (reindex_inj rev_ord_inj) /=; apply: eq_bigr => i _.
have ni : (i <= n)%N by rewrite -ltnS.
rewrite !coef_cpoly coef_rev subSS leq_subr subKn // mulrCA; congr (_ * _).
by rewrite exprVn exprB ?unitfE.
Qed.

(** For a stable polynomial the reversed one is no larger outside the unit circle. *)
Lemma rev_le n p z : stable n p -> 1 <= `|z| ->
  `|(cpoly (rev_poly n p)).[z]| <= `|(cpoly p).[z]|.
Proof.
case=> sp pn inside z1.
have z0 : z != 0 by rewrite -normr_gt0 (lt_le_trans ltr01).
have zc0 : z^* != 0 by rewrite conjC_eq0.
have -> : `|(cpoly (rev_poly n p)).[z]| = `|z| ^+ n * `|(cpoly p).[(z^*)^-1]|.
  rewrite horner_rev // normrM normrX; congr (_ * _).
  by rewrite -[RHS]norm_conjC -conj_cpoly fmorphV conjCK.
have szp : size p = n.+1.
  by apply/eqP; rewrite eqn_leq sp ltnNge; apply: contra pn => h; rewrite nth_default.
have [r pE] := closed_field_poly_normal (cpoly p).
have l0 : lead_coef (cpoly p) != 0.
  by rewrite lead_coefE coef_cpoly size_cpoly szp /= eq_complex /= eqxx andbT.
have szr : size r = n.
  have := congr1 (fun q : {poly C} => size q) pE.
  by rewrite size_scale // size_prod_XsubC size_cpoly szp => -[].
have rin x : x \in r -> `|x| < 1.
  by move=> xr; apply: inside; rewrite pE rootZ // root_prod_XsubC.
rewrite pE !hornerZ !normrM mulrCA ler_wpmul2l // -szr.
elim: r {pE szr} rin => [|x r IH] rin.
  by rewrite !big_nil expr0 mul1r !hornerC.
rewrite !big_cons !hornerM !normrM exprS mulrACA.
apply: ler_pmul; rewrite ?mulr_ge0 ?exprn_ge0 //; last first.
  by apply: IH => y yr; apply: rin; rewrite in_cons yr orbT.
have x1 : `|x| < 1 by rewrite rin // mem_head.
rewrite !hornerXsubC -(ler_pexpn2r (ltn0Sn 1)) ?nnegrE ?mulr_ge0 //.
rewrite -[X in X * _]norm_conjC -normrM mulrBr divff // !normCK.
rewrite !rmorphB rmorphM rmorph1 !conjCK -subr_ge0.
have -> : (z - x) * (z^* - x^*) - (1 - z^* * x) * (1 - z * x^*) = (z * z^* - 1) * (1 - x * x^*).
  by ring.
by rewrite mulr_ge0 // subr_ge0 -normCK ?exprn_ege1 ?exprn_ile1 // ltW.
Qed.

(** ** One step of the table *)

Lemma sqr_lt (a b : R) : (a ^+ 2 < b ^+ 2) = (`|a%:C%C : C| < `|b%:C%C : C|).
Proof.
rewrite !norm_real ltcR -(real_normK (num_real a)) -(real_normK (num_real b)).
by rewrite ltr_pexpn2r ?nnegrE.
Qed.

Lemma stable_size n p : stable n p -> size p = n.+1.
Proof.
case=> sp pn _; apply/eqP; rewrite eqn_leq sp ltnNge.
by apply: contra pn => h; rewrite nth_default.
Qed.

(** The last coefficient is the product of the roots. *)
Lemma stable_ends n p : stable n.+1 p -> p`_0 ^+ 2 < p`_n.+1 ^+ 2.
Proof.
move=> st; have szp := stable_size st; case: st => sp pn inside.
have [r pE] := closed_field_poly_normal (cpoly p).
have l0 : lead_coef (cpoly p) = (p`_n.+1)%:C%C.
  by rewrite lead_coefE coef_cpoly size_cpoly szp.
have l1 : lead_coef (cpoly p) != 0 by rewrite l0 eq_complex /= eqxx andbT.
have szr : size r = n.+1.
  have := congr1 (fun q : {poly C} => size q) pE.
  by rewrite size_scale // size_prod_XsubC size_cpoly szp => -[].
have rin x : x \in r -> `|x| < 1.
  by move=> xr; apply: inside; rewrite pE rootZ // root_prod_XsubC.
have p0 : (p`_0)%:C%C = (cpoly p).[0] by rewrite horner_coef0 coef_cpoly.
rewrite sqr_lt -l0 p0 {1}pE hornerZ normrM gtr_pmulr ?normr_gt0 //.
case: r {pE} szr rin => // x r _ rin; elim: r x rin => [|y r IH] x rin.
  by rewrite big_seq1 hornerXsubC sub0r normrN rin ?mem_head.
rewrite big_cons hornerM normrM hornerXsubC sub0r normrN.
apply: mulr_ilt1 => //; first by rewrite rin ?mem_head.
by apply: IH => t tr; apply: rin; rewrite in_cons tr orbT.
Qed.

Lemma stable_row n p : stable n.+1 p -> stable n (row n.+1 p).
Proof.
move=> st; have ends := stable_ends st; have blaschke := rev_le st.
case: st => sp pn inside; split; first exact: size_row.
  by rewrite lead_row subr_eq0 gt_eqF.
move=> z; rewrite real_ltNge ?ger0_real // => /rootP qz; apply/negP => z1.
have pz : (cpoly p).[z] != 0.
  by apply/eqP => /rootP/inside; rewrite real_ltNge ?ger0_real // z1.
have := congr1 (fun q => (cpoly q).[z]) (rowE sp).
rewrite cpolyB !cpolyZ cpolyXM hornerM qz mulr0.
move/esym/eqP; rewrite hornerD hornerN !hornerZ subr_eq0 => /eqP e.
have := blaschke z z1; have := congr1 (fun x : C => `|x|) e; rewrite !normrM => e1 le.
have : `|(p`_n.+1)%:C%C : C| * `|(cpoly p).[z]| <= `|(p`_0)%:C%C : C| * `|(cpoly p).[z]|.
  by rewrite e1 ler_wpmul2l.
by rewrite ler_pmul2r ?normr_gt0 // real_leNgt ?ger0_real // -sqr_lt ends.
Qed.

Lemma row_stable n p : (size p <= n.+2)%N -> p`_0 ^+ 2 < p`_n.+1 ^+ 2 ->
  stable n (row n.+1 p) -> stable n.+1 p.
Proof.
move=> sp ends st; have blaschke := rev_le st; case: st => sq qn inside; split=> //.
  by apply: contraTneq ends => ->; rewrite expr0n /= -leNgt sqr_ge0.
move=> z; rewrite real_ltNge ?ger0_real // => /rootP pz; apply/negP => z1.
have qz : (cpoly (row n.+1 p)).[z] != 0.
  by apply/eqP => /rootP/inside; rewrite real_ltNge ?ger0_real // z1.
have := congr1 (fun q => (cpoly q).[z]) (row_inv sp).
rewrite cpolyD !cpolyZ cpolyXM hornerZ pz mulr0.
move/esym/eqP; rewrite hornerD !hornerZ addr_eq0 hornerM hornerX => /eqP e.
have := blaschke z z1; have := congr1 (fun x : C => `|x|) e; rewrite normrN !normrM => e1 le.
have : `|(p`_n.+1)%:C%C : C| * `|(cpoly (row n.+1 p)).[z]|
       <= `|(p`_0)%:C%C : C| * `|(cpoly (row n.+1 p)).[z]|.
  apply: (@le_trans _ _ (`|(p`_0)%:C%C : C| * `|(cpoly (rev_poly n (row n.+1 p))).[z]|)).
    by rewrite -e1 ler_wpmul2l // ler_pemull.
  by rewrite ler_wpmul2l.
by rewrite ler_pmul2r ?normr_gt0 // real_leNgt ?ger0_real // -sqr_lt ends.
Qed.

Theorem jury_step n p : (size p <= n.+2)%N ->
  stable n.+1 p <-> p`_0 ^+ 2 < p`_n.+1 ^+ 2 /\ stable n (row n.+1 p).
Proof.
move=> sp; split=> [st|[ends]]; last exact: row_stable.
by split; [apply: stable_ends | apply: stable_row].
Qed.

Lemma stable0 p : (size p <= 1)%N -> stable 0 p <-> p`_0 != 0.
Proof.
move=> sp; split=> [[]//|p0]; split=> // z.
by rewrite (size1_polyC sp) /cpoly map_polyC rootC eq_complex /= eqxx andbT (negPf p0).
Qed.

(** ** The criterion *)

Theorem jury_criterion n p : (size p <= n.+1)%N -> stable n p <-> jury n p.
Proof.
elim: n p => [|n IH] p sp; first exact: stable0.
by rewrite jury_step //= IH // size_row.
Qed.

Lemma stableZ (c : R) n p : c != 0 -> stable n (c *: p) <-> stable n p.
Proof.
move=> c0; have cC : c%:C%C != 0 :> C by rewrite eq_complex /= eqxx andbT.
rewrite /stable size_scale // coefZ mulf_eq0 (negPf c0) /=.
by split=> -[-> -> H]; split=> // z rz; apply: H; move: rz; rewrite cpolyZ rootZ.
Qed.

(** ** The last row replaced by the signs at 1 and -1

    The last condition of the table has the highest degree; the values of the polynomial itself at
    1 and -1 decide the same. *)

(** The rows down to degree 1; each condition is "the next row begins with a positive lead". *)
Fixpoint inner n p : Prop :=
  if n is (_.+1 as n').+1 then 0 < (row n p)`_n' /\ inner n' (row n p) else True.

Lemma horner_rev1 n p : (size p <= n.+1)%N -> (rev_poly n p).[1] = p.[1].
Proof.
move=> sp; rewrite (@horner_coef_wide _ n.+1) ?size_poly // (@horner_coef_wide _ n.+1 p) //.
rewrite (reindex_inj rev_ord_inj) /=; apply: eq_bigr => i _.
by rewrite coef_rev subSS leq_subr subKn ?expr1n // -ltnS.
Qed.

Lemma horner_revN1 n p : (size p <= n.+1)%N -> (rev_poly n p).[-1] = (-1) ^+ n * p.[-1].
Proof.
move=> sp; rewrite (@horner_coef_wide _ n.+1) ?size_poly // (@horner_coef_wide _ n.+1 p) //.
rewrite mulr_sumr (reindex_inj rev_ord_inj) /=; apply: eq_bigr => i _.
have ni : (i <= n)%N by rewrite -ltnS.
rewrite coef_rev subSS leq_subr subKn // mulrCA; congr (_ * _).
by rewrite -signr_odd oddB // -[in RHS]signr_odd -[X in _ * X]signr_odd signr_addb.
Qed.

Lemma row_at1 n p : (size p <= n.+2)%N -> (row n.+1 p).[1] = (p`_n.+1 - p`_0) * p.[1].
Proof.
move=> sp; have := congr1 (fun q : {poly R} => q.[1]) (rowE sp).
by rewrite !(hornerM, hornerX, hornerD, hornerN, hornerZ) horner_rev1 // mul1r => ->; ring.
Qed.

Lemma row_atN1 n p : (size p <= n.+2)%N ->
  (-1) ^+ n * (row n.+1 p).[-1] = (p`_n.+1 - (-1) ^+ n.+1 * p`_0) * ((-1) ^+ n.+1 * p.[-1]).
Proof.
move=> sp; have := congr1 (fun q : {poly R} => q.[-1]) (rowE sp).
rewrite !(hornerM, hornerX, hornerD, hornerN, hornerZ) horner_revN1 // mulN1r => /(canRL (@opprK _)) ->; rewrite exprS.
by move: ((-1) ^+ n) => s; ring.
Qed.

Lemma lead_sub (a b : R) : a ^+ 2 < b ^+ 2 -> 0 < b * (b - a).
Proof.
move=> ab; have : 0 < (b ^+ 2 - a ^+ 2) + (b - a) ^+ 2 by rewrite ltr_paddr ?sqr_ge0 ?subr_gt0.
have -> : (b ^+ 2 - a ^+ 2) + (b - a) ^+ 2 = 2%:R * (b * (b - a)) by ring.
by rewrite pmulr_rgt0 ?ltr0n.
Qed.

Lemma lead_pos (a b x : R) : 0 < b * a -> (0 < b * x) = (0 < a * x).
Proof.
move=> ba; have b0 : b != 0 by apply: contraTneq ba => ->; rewrite mul0r ltxx.
rewrite -(pmulr_rgt0 _ ba); have -> : b * a * (b * x) = b ^+ 2 * (a * x) by ring.
by rewrite pmulr_rgt0 // exprn_even_gt0.
Qed.

Theorem inner_criterion n p : (size p <= n.+2)%N ->
  stable n.+1 p <->
  [/\ inner n.+1 p, 0 < p`_n.+1 * p.[1] & 0 < p`_n.+1 * ((-1) ^+ n.+1 * p.[-1])].
Proof.
elim: n p => [|n IH] p sp; rewrite jury_step //.
  have -> : p.[1] = p`_1 + p`_0.
    by rewrite (horner_coef_wide _ sp) !big_ord_recr big_ord0 /= expr0 expr1n; ring.
  have -> : (-1) ^+ 1 * p.[-1] = p`_1 - p`_0.
    by rewrite (horner_coef_wide _ sp) !big_ord_recr big_ord0 /= expr0 !expr1; ring.
  rewrite stable0 ?size_row //; split=> [[ends _]|[_ l1 lN1]].
    split=> //; last exact: lead_sub.
    by rewrite -[p`_0]opprK lead_sub // sqrrN.
  have p1 : p`_1 != 0 by apply: contraTneq l1 => ->; rewrite mul0r ltxx.
  have ends : p`_0 ^+ 2 < p`_1 ^+ 2.
    rewrite -subr_gt0 -(pmulr_rgt0 _ (_ : 0 < p`_1 ^+ 2)) ?exprn_even_gt0 //.
    have -> : p`_1 ^+ 2 * (p`_1 ^+ 2 - p`_0 ^+ 2)
      = p`_1 * (p`_1 + p`_0) * (p`_1 * (p`_1 - p`_0)) by ring.
    exact: mulr_gt0.
  by split=> //; rewrite lead_row subr_eq0 gt_eqF.
rewrite IH ?size_row // row_at1 // row_atN1 //.
have E : inner n.+2 p = (0 < (row n.+2 p)`_n.+1 /\ inner n.+1 (row n.+2 p)) by [].
rewrite E {E}; have gt := lead_row n.+1 p.
have le1 : 0 < (row n.+2 p)`_n.+1 ->
  (0 < (row n.+2 p)`_n.+1 * ((p`_n.+2 - p`_0) * p.[1])) = (0 < p`_n.+2 * p.[1]).
  rewrite gt subr_gt0 => ends; rewrite -gt pmulr_rgt0; last by rewrite gt subr_gt0.
  by rewrite -(lead_pos p.[1] (lead_sub ends)).
have leN1 : 0 < (row n.+2 p)`_n.+1 ->
  (0 < (row n.+2 p)`_n.+1 * ((p`_n.+2 - (-1) ^+ n.+2 * p`_0) * ((-1) ^+ n.+2 * p.[-1])))
  = (0 < p`_n.+2 * ((-1) ^+ n.+2 * p.[-1])).
  rewrite gt subr_gt0 => ends; rewrite -gt pmulr_rgt0; last by rewrite gt subr_gt0.
  rewrite -(lead_pos ((-1) ^+ n.+2 * p.[-1]) (lead_sub (a := (-1) ^+ n.+2 * p`_0) _)) //.
  by rewrite exprMn -exprM mulnC exprM sqrrN !expr1n mul1r.
split=> [[ends [inn one mone]]|[[lead inn] one mone]].
  have lead : 0 < (row n.+2 p)`_n.+1 by rewrite gt subr_gt0.
  by rewrite -le1 // -leN1.
by split; [rewrite -subr_gt0 -gt | split; rewrite // ?le1 ?leN1].
Qed.

End Jury.
