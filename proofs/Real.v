(** What the integers, fractions and lists of the computing part stand for in a real closed field,
    and that the arithmetic on them is right. *)

From Coq Require Import ZArith QArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ring.
From Jurist Require Import Compute.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Values.
Variable R : rcfType.

(** ** Integers and fractions *)

Fixpoint pr (p : positive) : R :=
  match p with xH => 1 | xO q => pr q + pr q | xI q => 1 + (pr q + pr q) end.
Definition zr (a : Z) : R := match a with Z0 => 0 | Zpos p => pr p | Zneg p => - pr p end.

(** The number a fraction or a decimal stands for: [qr 0.25]. *)
Definition qr (q : Q) : R :=
  match Qden q with xH => zr (Qnum q) | d => zr (Qnum q) / pr d end.

Lemma qrE q : qr q = zr (Qnum q) / pr (Qden q).
Proof. by case: q => n [d|d|] //=; rewrite divr1. Qed.

Lemma pr_nat p : pr p = (Pos.to_nat p)%:R.
Proof.
elim: p => [p IH|p IH|] //=; rewrite ?Pos2Nat.inj_xI ?Pos2Nat.inj_xO IH.
  by rewrite -[in RHS]add1n natrD multE natrM mulrDl mul1r.
by rewrite multE natrM mulrDl mul1r.
Qed.

Lemma pr_gt0 p : 0 < pr p.
Proof. by rewrite pr_nat ltr0n; apply/ssrnat.ltP/Pos2Nat.is_pos. Qed.

Lemma prD p q : pr (p + q) = pr p + pr q.
Proof. by rewrite !pr_nat Pos2Nat.inj_add natrD. Qed.

Lemma prM p q : pr (p * q) = pr p * pr q.
Proof. by rewrite !pr_nat Pos2Nat.inj_mul natrM. Qed.

Lemma zrN a : zr (- a) = - zr a.
Proof. by case: a => [|p|p] /=; rewrite ?oppr0 ?opprK. Qed.

Lemma zr_sub p q : zr (Z.pos_sub p q) = pr p - pr q.
Proof.
rewrite Z.pos_sub_spec; case: Pos.compare_spec => [->|pq|qp] /=; first by rewrite subrr.
  by rewrite -{2}(Pos.sub_add _ _ pq) prD opprD addrCA subrr addr0.
by rewrite -{2}(Pos.sub_add _ _ qp) prD addrK.
Qed.

Lemma zrD a b : zr (a + b) = zr a + zr b.
Proof.
case: a b => [|p|p] [|q|q] //=; rewrite ?add0r ?addr0 ?prD ?opprD ?zr_sub //.
by rewrite addrC.
Qed.

Lemma zrM a b : zr (a * b) = zr a * zr b.
Proof. by case: a b => [|p|p] [|q|q] /=; rewrite ?mul0r ?mulr0 ?prM ?mulrNN ?mulNr ?mulrN. Qed.

Lemma zr_gt0 a : Z.ltb 0 a = (0 < zr a).
Proof.
by case: a => [|p|p] /=; rewrite ?ltxx ?pr_gt0 // oppr_gt0 lt_gtF ?pr_gt0.
Qed.

Lemma zr_ge0 a : Z.leb 0 a = (0 <= zr a).
Proof.
case: a => [|p|p] /=; first by rewrite lexx.
  by rewrite ltW ?pr_gt0.
by rewrite oppr_ge0 lt_geF ?pr_gt0.
Qed.

Lemma zr_le0 a : Z.leb a 0 = (zr a <= 0).
Proof.
case: a => [|p|p] /=; first by rewrite lexx.
  by rewrite lt_geF ?pr_gt0.
by rewrite oppr_le0 ltW ?pr_gt0.
Qed.

Lemma zr_lt0 a : Z.ltb a 0 = (zr a < 0).
Proof.
case: a => [|p|p] /=; first by rewrite ltxx.
  by rewrite lt_gtF ?pr_gt0.
by rewrite oppr_lt0 pr_gt0.
Qed.

Lemma zr_eq0 a : Z.eqb 0 a = (zr a == 0).
Proof.
case: a => [|p|p] /=; first by rewrite eqxx.
  by rewrite gt_eqF ?pr_gt0.
by rewrite oppr_eq0 gt_eqF ?pr_gt0.
Qed.

Arguments Z.eqb : simpl never.
Arguments Z.ltb : simpl never.
Arguments Z.leb : simpl never.
Arguments Z.mul : simpl never.
Arguments Z.add : simpl never.
Arguments Z.opp : simpl never.

Lemma eqb_zr a b : Z.eqb a b -> zr a = zr b.
Proof. by move/Z.eqb_eq => ->. Qed.

(** ** Polynomials in the parameter *)

Fixpoint pev (p : poly) (x : R) : R := match p with nil => 0 | a :: p' => zr a + x * pev p' x end.

Implicit Types (p q : poly) (x : R).

Lemma pevD p q x : pev (padd p q) x = pev p x + pev q x.
Proof.
elim: p q => [|a p IH] [|b q] /=; rewrite ?add0r ?addr0 //.
by rewrite IH zrD; ring.
Qed.

Lemma pevZ c p x : pev (pscale c p) x = zr c * pev p x.
Proof. by elim: p => [|a p IH] /=; rewrite ?mulr0 // IH zrM; ring. Qed.

Lemma pevN p x : pev (popp p) x = - pev p x.
Proof. by elim: p => [|a p IH] /=; rewrite ?oppr0 // IH zrN; ring. Qed.

Lemma pevB p q x : pev (psub p q) x = pev p x - pev q x.
Proof. by rewrite pevD pevN. Qed.

Lemma pevM p q x : pev (pmul p q) x = pev p x * pev q x.
Proof.
elim: p => [|a p IH] /=; first by rewrite mul0r.
case: Z.eqb_spec => [->|_] /=; first by rewrite IH; ring.
by rewrite pevD pevZ /= IH; ring.
Qed.

Lemma pev_zero p x : pzero p -> pev p x = 0.
Proof.
elim: p => //= a p IH /andP[]; rewrite zr_eq0 => /eqP-> /IH->.
by rewrite mulr0 addr0.
Qed.

Lemma pev_eq p q x : peqb p q -> pev p x = pev q x.
Proof. by move/(pev_zero x); rewrite pevB => /subr0_eq. Qed.

Lemma pev_trim p x : pev (ptrim p) x = pev p x.
Proof.
elim: p => //= a p <-; case: (ptrim p) => [|b q] //=.
by case: Z.eqb_spec => [->|_] /=; rewrite ?mulr0 ?addr0.
Qed.

Lemma pev_prim p x : exists2 c, 0 < c & pev p x = c * pev (pprim p) x.
Proof.
rewrite /pprim; case: ifP => [/andP[c0 /(pev_eq x)->]|_].
  by exists (zr (pcontent p)); rewrite -?zr_gt0 ?pevZ.
by exists 1; rewrite ?ltr01 ?mul1r.
Qed.

Lemma pev_lin a b p x : pev (plin a b p) x = (zr a + zr b * x) * pev p x.
Proof. by rewrite pevD pevZ /= pevZ; ring. Qed.

Fixpoint ppoly (p : poly) : {poly R} := match p with nil => 0 | a :: p' => (zr a)%:P + 'X * ppoly p' end.

Lemma horner_ppoly p x : (ppoly p).[x] = pev p x.
Proof. by elim: p => [|a p IH] /=; rewrite ?horner0 // !(hornerD, hornerM, hornerC, hornerX) IH. Qed.

Lemma coef_ppoly p i : (ppoly p)`_i = zr (List.nth i p Z0).
Proof.
elim: p i => [|a p IH] [|i] /=; rewrite ?coef0 // coefD coefC coefXM /= ?addr0 //.
by rewrite add0r IH.
Qed.

Lemma nth_pderiv_from k p i :
  zr (List.nth i (pderiv_from k p) Z0) = (zr k + i%:R) * zr (List.nth i p Z0).
Proof.
elim: p k i => [|a p IH] k [|i]; rewrite /= ?mulr0 //; first by rewrite zrM addr0.
by rewrite IH zrD -[i.+1]addn1 natrD /=; ring.
Qed.

Lemma ppoly_deriv p : ppoly (pderiv p) = (ppoly p)^`().
Proof.
apply/polyP => i; rewrite coef_deriv !coef_ppoly nth_pderiv_from.
have -> : zr 1 + i%:R = i.+1%:R by rewrite -[i.+1]add1n natrD.
by rewrite mulr_natl; case: p i => [|a p] [|i].
Qed.

(** ** Polynomials in z *)

Fixpoint bpev (l : bipoly) (x : R) : {poly R} :=
  match l with nil => 0 | a :: l' => (pev a x)%:P + 'X * bpev l' x end.

Implicit Types l m : bipoly.

Lemma coef_bpev l x i : (bpev l x)`_i = pev (List.nth i l nil) x.
Proof.
elim: l i => [|a l IH] [|i] /=; rewrite ?coef0 // coefD coefC coefXM /= ?addr0 //.
by rewrite add0r IH.
Qed.

Lemma size_bpev l x : (size (bpev l x) <= length l)%N.
Proof.
apply/leq_sizeP => j; elim: l j => [|a l IH] [|j] //=; rewrite ?coef0 // ltnS => lj.
by rewrite coefD coefC coefXM /= add0r IH.
Qed.

Lemma bpevD l m x : bpev (badd l m) x = bpev l x + bpev m x.
Proof.
elim: l m => [|a l IH] [|b m] /=; rewrite ?add0r ?addr0 //.
by rewrite IH pevD polyCD; ring.
Qed.

Lemma bpevZ c l x : bpev (bscale c l) x = pev c x *: bpev l x.
Proof.
rewrite -mul_polyC; elim: l => [|a l IH] /=; rewrite ?mulr0 // IH pev_trim pevM polyCM; ring.
Qed.

Lemma bpevN l x : bpev (bopp l) x = - bpev l x.
Proof. by elim: l => [|a l IH] /=; rewrite ?oppr0 // IH pevN polyCN; ring. Qed.

Lemma bpevM l m x : bpev (bmul l m) x = bpev l x * bpev m x.
Proof.
elim: l => [|a l IH] /=; rewrite ?mul0r // bpevD bpevZ /= IH -mul_polyC add0r; ring.
Qed.

Lemma bpev_zero l x : bzero l -> bpev l x = 0.
Proof. by elim: l => //= a l IH /andP[/(pev_zero x)-> /IH->]; rewrite mulr0 addr0. Qed.

Lemma bpev_one l x : pev (at_one l) x = (bpev l x).[1].
Proof.
elim: l => [|a l IH] /=; rewrite ?horner0 // pevD IH.
by rewrite !(hornerD, hornerM, hornerC, hornerX) mul1r.
Qed.

Lemma bpev_minus_one l x : pev (at_minus_one l) x = (bpev l x).[-1].
Proof.
elim: l => [|a l IH] /=; rewrite ?horner0 // pevB IH.
by rewrite !(hornerD, hornerM, hornerC, hornerX) mulN1r.
Qed.

Lemma bpev_all2 c f l m x :
  all2 (fun y z => peqb y (pscale c (pmul f z))) l m -> bpev l x = (zr c * pev f x) *: bpev m x.
Proof.
rewrite -mul_polyC; elim: l m => [|a l IH] [|b m] //=; first by rewrite mulr0.
case/andP => /(pev_eq x)-> /IH->; rewrite pevZ pevM !polyCM; ring.
Qed.

Lemma bpev_prim l x : exists2 c, 0 < c & bpev l x = c *: bpev (bprim l) x.
Proof.
rewrite /bprim; case: ifP => [/andP[c0 H]|_]; last by exists 1; rewrite ?ltr01 ?scale1r.
exists (zr (bcontent l)); first by rewrite -zr_gt0.
move: (bcontent l) H => c; rewrite -mul_polyC; elim: {c0}l => [|a l IH] /=; first by rewrite mulr0.
case/andP => /(pev_eq x)-> /IH->; rewrite pevZ polyCM; ring.
Qed.

End Values.
