(** One point: every parameter has a value. Whether the loop is stable there is decided by Jury's table of
    numbers, and stated of eigenvalues or of the roots of a polynomial, in both directions. *)

From Coq Require Import ZArith QArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Compute Entries Jury Real Sound Answer Region Eigenvalues.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Point.
Variable R : rcfType.
Local Notation C := R[i].
Implicit Types (l : bipoly) (z : C).

Lemma point_jury_ok n l : length l = n.+1 -> point_jury n l <-> jury n (bpev l (qr R 0)).
Proof.
elim: n l => [|n IH] l ln.
  by rewrite /= hd_nth coef_bpev (pval_eq0 R).
have -> : point_jury n.+1 l = if Z.ltb 0 (pval 0 (List.last (bprim (jrow l)) nil))
    then point_jury n (bprim (jrow l)) else false by [].
have lq : length (bprim (jrow l)) = n.+1 by rewrite length_bprim length_jrow ln.
have [c c0 rE] := bpev_prim (jrow l) (qr R 0); rewrite (bpev_jrow _ ln) in rE.
rewrite [jury n.+1 _]/= rE (pval_gt0 R) last_nth lq -[List.nth _.-1 _ _]/(List.nth n _ _) -coef_bpev.
have leadE : ((bpev l (qr R 0))`_0 ^+ 2 < (bpev l (qr R 0))`_n.+1 ^+ 2) = (0 < (bpev (bprim (jrow l)) (qr R 0))`_n).
  by rewrite -[LHS]subr_gt0 -lead_row rE coefZ pmulr_rgt0.
rewrite leadE.
have size_q : (size (bpev (bprim (jrow l)) (qr R 0)) <= n.+1)%N by rewrite -lq size_bpev.
have scaled : jury n (c *: bpev (bprim (jrow l)) (qr R 0)) <-> jury n (bpev (bprim (jrow l)) (qr R 0)).
  have size_cq : (size (c *: bpev (bprim (jrow l)) (qr R 0)) <= n.+1)%N by rewrite (leq_trans (size_scale_leq _ _)).
  by rewrite -(jury_criterion size_q) -(jury_criterion size_cq); apply: stableZ (lt0r_neq0 c0).
have J := IH _ lq; case: (0 < _); last by split=> // -[].
by split=> [/J/scaled//|[_ /scaled/J]].
Qed.

Lemma point_in_ok r n l : length l = n.+1 -> region_ok r ->
  point_in r n l <-> all_in r n (bpev l (qr R 0)).
Proof.
move=> ln ok; have lp : length (bprim (to_disc r l)) = n.+1 by rewrite length_bprim length_to_disc.
have size_p : (size (bpev (bprim (to_disc r l)) (qr R 0)) <= n.+1)%N by rewrite -lp size_bpev.
rewrite /point_in (to_disc_ok _ ln ok) (point_jury_ok lp) -(jury_criterion size_p).
have [c c0 ->] := bpev_prim (to_disc r l) (qr R 0).
by have := stableZ n (bpev (bprim (to_disc r l)) (qr R 0)) (lt0r_neq0 c0); tauto.
Qed.

(** ** What is said where the loop is not stable *)

(** On the boundary of the region or beyond it. *)
Definition outside (r : region) z : bool :=
  match r with
  | Disc q => (qr R q)%:C%C <= `|z|
  | Left a => match Qnum a with Z0 => 0 <= complex.Re z | _ => - qr R a <= complex.Re z end
  end.

Lemma outsideE r z : outside r z = ~~ inside r z.
Proof.
case: r => q; rewrite /outside /inside; last by case: (Qnum q) => *; rewrite leNgt.
by rewrite real_leNgt ?normr_real // complex_real.
Qed.

Lemma root_outside r (p : {poly R}) : p != 0 ->
  ~ (forall z, root (cpoly p) z -> inside r z) -> exists z, root (cpoly p) z /\ outside r z.
Proof.
move=> p0 notin; have c0 : lead_coef (cpoly p) != 0 by rewrite lead_coef_eq0 map_poly_eq0.
have [rs E] := closed_field_poly_normal (cpoly p).
have rootE z : root (cpoly p) z = (z \in rs) by rewrite E rootZ // root_prod_XsubC.
case: (boolP (all (inside r) rs)) => [/allP all_rs|/allPn[z zin nz]].
  by case: notin => z; rewrite rootE => /all_rs.
by exists z; rewrite rootE outsideE.
Qed.

(** ** What a generated file uses *)

Let guarded (gs : list poly) : point_nonzero gs -> nonzero gs (qr R 0).
Proof. by move=> H p /(proj1 (forallb_forall _ _) H); rewrite (pval_eq0 R). Qed.

Lemma matrix_point_ok r n (A : matrix) : point_matrix_ok r n A ->
  point_in r n (charpoly n A) <-> eigenvalues_in r (mx n n A (qr R 0)).
Proof.
case/andP => /andP[/andP[/guarded gs rows] /PeanoNat.Nat.eqb_spec ln] ok.
by rewrite (point_in_ok ln ok) (eigenvalues_charpoly gs rows r ln).
Qed.

Theorem matrix_stable r n (A : matrix) : check_matrix_point r n A true ->
  eigenvalues_in r (mx n n A (qr R 0)).
Proof. by case/andP => /matrix_point_ok E /eqb_prop/E. Qed.

Theorem matrix_not_stable r n (A : matrix) : check_matrix_point r n A false ->
  exists z : C, eigenvalue (map_mx (real_complex R) (mx n n A (qr R 0))) z /\ outside r z.
Proof.
case/andP => /matrix_point_ok E /eqb_prop no; move: (mx n n A (qr R 0)) E => M E.
have rootE z : root (cpoly (char_poly M)) z = eigenvalue (map_mx (real_complex R) M) z.
  by rewrite eigenvalue_root_char /cpoly map_char_poly.
have [||z []] := @root_outside r (char_poly M); first by rewrite monic_neq0 ?char_poly_monic.
  by move=> H; have := proj2 E (fun z => H z \o etrans (rootE z)); rewrite no.
by rewrite rootE => ev out; exists z.
Qed.

Lemma feedback_mx n m q (A B K C' : matrix) :
  mx n n (feedback n m q A B K C') (qr R 0)
  = mx n n A (qr R 0) - mx n m B (qr R 0) *m mx m q K (qr R 0) *m mx q n C' (qr R 0).
Proof. exact: feedback_ok. Qed.

Theorem feedback_stable r n m q (A B K C' : matrix) : check_matrix_point r n (feedback n m q A B K C') true ->
  eigenvalues_in r (mx n n A (qr R 0) - mx n m B (qr R 0) *m mx m q K (qr R 0) *m mx q n C' (qr R 0)).
Proof. by move/matrix_stable; rewrite feedback_mx. Qed.

Theorem feedback_not_stable r n m q (A B K C' : matrix) : check_matrix_point r n (feedback n m q A B K C') false ->
  exists z : C, eigenvalue (map_mx (real_complex R) (mx n n A (qr R 0)
    - mx n m B (qr R 0) *m mx m q K (qr R 0) *m mx q n C' (qr R 0))) z /\ outside r z.
Proof. by move/matrix_not_stable; rewrite feedback_mx. Qed.

Lemma poly_point_ok r (l : list expr) : point_coefs_ok r l ->
  point_in r (size l).-1 (cleared (coefs l)) <-> all_in r (size l).-1 (poly_of l (qr R 0)).
Proof.
case/andP => /andP[/andP[/guarded nz ok] rok] /PeanoNat.Nat.eqb_spec ln.
have lc : length (cleared (coefs l)) = (size l).-1.+1.
  by rewrite /cleared /coefs !map_length; exact: ln.
by rewrite (point_in_ok lc rok) (all_in_cleared _ _ ok nz).
Qed.

Theorem poly_stable r (l : list expr) : check_coefs_point r l true ->
  let p := poly_of l (qr R 0) in
  p`_((size l).-1) != 0 /\ forall z : C, root (map_poly (real_complex R) p) z -> inside r z.
Proof. by case/andP => /poly_point_ok E /eqb_prop/E. Qed.

Theorem poly_not_stable r (l : list expr) : check_coefs_point r l false ->
  let p := poly_of l (qr R 0) in
  p`_((size l).-1) = 0 \/ exists z : C, root (map_poly (real_complex R) p) z /\ outside r z.
Proof.
case/andP => /poly_point_ok E /eqb_prop no p; case: (eqVneq (p`_((size l).-1)) 0) => lead; first by left.
right; apply: root_outside; first by apply: contraNneq lead => ->; rewrite coef0.
by move=> H; have := proj2 E (conj lead H); rewrite no.
Qed.

End Point.

Arguments matrix_stable R {r n A} _ _ _.
Arguments feedback_stable R {r n m q A B K C'} _ _ _.
