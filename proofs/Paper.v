(** The Jury test of the paper, in the paper's words.

    F. Gürbüz and E. Akpınar, "Stability Analysis of a Closed-Loop Control for a Pulse Width
    Modulated DC Motor Drive", 2002: Q(z) of Eq. (25), the rows of Table 1 by Eqs. (26)-(29), and the
    conditions (30)-(36). The theorem at the end says that the conditions hold if and only if all the
    roots of Q are inside the unit circle. *)

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mathcomp Require Import ring.
From Jurist Require Import Jury.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Table1.
Variable R : rcfType.          (* the real numbers, or any real closed field *)
Local Notation C := R[i].

(** Eq. (25), with a_6 > 0. *)
Variables a0 a1 a2 a3 a4 a5 a6 : R.
Hypothesis a6_positive : 0 < a6.

Definition Q : {poly R} :=
  a6 *: 'X^6 + a5 *: 'X^5 + a4 *: 'X^4 + a3 *: 'X^3 + a2 *: 'X^2 + a1 *: 'X + a0%:P.

(** The determinant of the rows [x y] and [z t]. *)
Definition det2 (x y z t : R) : R := x * t - y * z.

(** Eq. (26): b_k = | a_0 a_{6-k} ; a_6 a_k |. *)
Definition b0 := det2 a0 a6 a6 a0.
Definition b1 := det2 a0 a5 a6 a1.
Definition b2 := det2 a0 a4 a6 a2.
Definition b3 := det2 a0 a3 a6 a3.
Definition b4 := det2 a0 a2 a6 a4.
Definition b5 := det2 a0 a1 a6 a5.

(** Eq. (27): c_k = | b_0 b_{5-k} ; b_5 b_k |. *)
Definition c0 := det2 b0 b5 b5 b0.
Definition c1 := det2 b0 b4 b5 b1.
Definition c2 := det2 b0 b3 b5 b2.
Definition c3 := det2 b0 b2 b5 b3.
Definition c4 := det2 b0 b1 b5 b4.

(** Eq. (28): d_k = | c_0 c_{4-k} ; c_4 c_k |. *)
Definition d0 := det2 c0 c4 c4 c0.
Definition d1 := det2 c0 c3 c4 c1.
Definition d2 := det2 c0 c2 c4 c2.
Definition d3 := det2 c0 c1 c4 c3.

(** Eq. (29): e_k = | d_0 d_{3-k} ; d_3 d_k |. *)
Definition e0 := det2 d0 d3 d3 d0.
Definition e1 := det2 d0 d2 d3 d1.
Definition e2 := det2 d0 d1 d3 d2.

(** Conditions (30)-(36). *)
Definition conditions : Prop :=
  [/\ (Q.[1] > 0 /\ (-1) ^+ 6 * Q.[-1] > 0),
      `|a0| < a6, `|b0| > `|b5|, `|c0| > `|c4| & `|d0| > `|d3| /\ `|e0| > `|e2| ].

Let QE : Q = Poly [:: a0; a1; a2; a3; a4; a5; a6].
Proof.
apply/polyP => k; rewrite coef_Poly /Q !coefD !coefZ !coefXn coefX coefC.
do 7 (case: k => [|k] /=; first by rewrite ?mulr0 ?mulr1 ?add0r ?addr0).
by rewrite nth_nil !mulr0 !addr0.
Qed.

(** The program's rows are those of Table 1 backwards, up to the sign. *)
Ltac table := apply/polyP;
  do 7 (case; first by rewrite coef_row !coef_Poly //= /det2; ring);
  by move=> ?; rewrite coef_row !coef_Poly.

Let row_b : row 6 Q = Poly [:: - b5; - b4; - b3; - b2; - b1; - b0].
Proof. rewrite QE /b0 /b1 /b2 /b3 /b4 /b5; table. Qed.

Let row_c : row 5 (Poly [:: - b5; - b4; - b3; - b2; - b1; - b0]) = Poly [:: c4; c3; c2; c1; c0].
Proof. rewrite /c0 /c1 /c2 /c3 /c4; table. Qed.

Let row_d : row 4 (Poly [:: c4; c3; c2; c1; c0]) = Poly [:: d3; d2; d1; d0].
Proof. rewrite /d0 /d1 /d2 /d3; table. Qed.

Let row_e : row 3 (Poly [:: d3; d2; d1; d0]) = Poly [:: e2; e1; e0].
Proof. rewrite /e0 /e1 /e2; table. Qed.

Let lt_norm (x y : R) : (`|x| < `|y|) = (0 < y ^+ 2 - x ^+ 2).
Proof. by rewrite subr_gt0 -(real_normK (num_real x)) -(real_normK (num_real y)) ltr_pexpn2r ?nnegrE. Qed.

Theorem table_1 :
  conditions <-> forall z : C, root (map_poly (real_complex R) Q) z -> `|z| < 1.
Proof.
have sQ : (size Q <= 7)%N by rewrite QE size_Poly.
have Q6 : Q`_6 = a6 by rewrite QE coef_Poly.
have -> : (forall z : C, root (map_poly (real_complex R) Q) z -> `|z| < 1) <-> stable 6 Q.
  by split=> [H|[]//]; split=> //; rewrite Q6 gt_eqF.
have innerE : inner 6 Q <->
  [/\ 0 < (row 6 Q)`_5, 0 < (row 5 (row 6 Q))`_4, 0 < (row 4 (row 5 (row 6 Q)))`_3,
      0 < (row 3 (row 4 (row 5 (row 6 Q))))`_2
    & 0 < (row 2 (row 3 (row 4 (row 5 (row 6 Q)))))`_1].
  by split=> [[A [B [D [E [F _]]]]]|[A B D E F]]; do ?split.
have b0E : - b0 = a6 ^+ 2 - a0 ^+ 2 by rewrite /b0 /det2; ring.
have c0E : c0 = b0 ^+ 2 - b5 ^+ 2 by rewrite /c0 /det2; ring.
have d0E : d0 = c0 ^+ 2 - c4 ^+ 2 by rewrite /d0 /det2; ring.
have e0E : e0 = d0 ^+ 2 - d3 ^+ 2 by rewrite /e0 /det2; ring.
rewrite row_b row_c row_d row_e lead_row !coef_Poly /= b0E in innerE.
rewrite inner_criterion // Q6 !(pmulr_rgt0 _ a6_positive) /conditions.
have -> : (`|a0| < a6) = (`|a0| < `|a6|) by rewrite (gtr0_norm a6_positive).
rewrite !lt_norm -c0E -d0E -e0E; split=> [[[q1 qN1] A B D [E F]]|[/innerE[A B D E F] q1 qN1]]; last by do ?split.
by split=> //; apply/innerE.
Qed.

End Table1.

Print Assumptions table_1.
