(** Roots in a region: inside a circle of radius r (discrete time), left of the line Re s = -a
    (continuous time). Both are the unit circle after s = (a + b z) / (c + d z). *)

From Coq Require Import ZArith QArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mathcomp Require Import ring.
From Jurist Require Import Compute Jury Real Sound Answer.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** ** A polynomial made homogeneous *)

Section Homogeneous.
Variable F : fieldType.
Implicit Types (s : seq F) (u v x : F).

(** The sum of s_k u^k v^(n-k), n = size s - 1, and v^(size s). *)
Fixpoint hom s u v : F * F :=
  if s is x :: s' then let: (h, w) := hom s' u v in (x * w + u * h, v * w) else (0, 1).

Fixpoint value s x : F := if s is a :: s' then a + x * value s' x else 0.

Lemma hom_w s u v : (hom s u v).2 = v ^+ size s.
Proof. by elim: s => //= x s; case: hom => h w /= ->; rewrite exprS. Qed.

Lemma hom_value s u v : v != 0 -> (hom s u v).1 * v = value s (u / v) * v ^+ size s.
Proof.
move=> v0; elim: s => [|x s] /=; first by rewrite !mul0r.
have := hom_w s u v; case: hom => h w /= -> e.
rewrite mulrDl -[u * h * v]mulrA e exprS.
have -> : u * (value s (u / v) * v ^+ size s) = u / v * v * (value s (u / v) * v ^+ size s).
  by rewrite mulfVK.
by move: (u / v) => k; ring.
Qed.

Lemma hom_eq0 s u v : v != 0 -> ((hom s u v).1 == 0) = (value s (u / v) == 0).
Proof.
move=> v0; have := hom_value s u v0; case: eqP => [->|h0] e; apply/esym; last first.
  apply/negbTE; apply: contra_not_neq h0 => e0; apply: (mulIf v0); rewrite e e0 !mul0r //.
by apply/eqP; apply: (mulIf (expf_neq0 (size s) v0)); rewrite -e !mul0r.
Qed.

Lemma hom_infinite x s u : (hom (x :: s) u 0).1 = last x s * u ^+ size s.
Proof.
elim: s x => [|y s IH] x; first by rewrite /= !mulr1 mulr0 addr0.
have {IH} := IH y; have := hom_w (y :: s) u 0; rewrite expr0n.
have -> : hom [:: x, y & s] u 0 = let: (h, w) := hom (y :: s) u 0 in (x * w + u * h, 0 * w) by [].
by case: (hom (y :: s) u 0) => h w /= -> ->; rewrite mulr0 add0r exprS mulrCA.
Qed.
End Homogeneous.

Section Region.
Variable R : rcfType.
Local Notation C := R[i].
Implicit Types (l : bipoly) (x : R) (z s : C).

(** ** The region, and what is said of a polynomial *)

Definition inside (r : region) z : bool :=
  match r with
  | Disc q => `|z| < (qr R q)%:C%C
  | Left a => match Qnum a with Z0 => complex.Re z < 0 | _ => complex.Re z < - qr R a end
  end.

(** It keeps its degree [n], and all its roots are in the region. *)
Definition all_in (r : region) n (p : {poly R}) : Prop :=
  p`_n != 0 /\ forall z, root (map_poly (real_complex R) p) z -> inside r z.

Definition reals l x : seq R := [seq pev a x | a <- l].
Definition complexes l x : seq C := [seq (pev a x)%:C%C | a <- l].

Lemma root_value l x z : root (cpoly (bpev l x)) z = (value (complexes l x) z == 0).
Proof.
rewrite rootE; congr (_ == 0); elim: l => [|a l IH] /=; first by rewrite /cpoly map_poly0 horner0.
by rewrite cpolyD cpolyXM hornerD hornerM hornerX IH /cpoly map_polyC hornerC.
Qed.

Lemma ppolyD (p q : poly) : ppoly R (padd p q) = ppoly R p + ppoly R q.
Proof. by elim: p q => [|k p IH] [|m q]; rewrite /= ?add0r ?addr0 // IH zrD polyCD; ring. Qed.

Lemma ppolyZ c (p : poly) : ppoly R (pscale c p) = (zr R c)%:P * ppoly R p.
Proof. by elim: p => [|k p IH]; rewrite /= ?mulr0 // IH zrM polyCM; ring. Qed.

Lemma ppoly_lin a b (p : poly) : ppoly R (plin a b p) = ((zr R a)%:P + (zr R b)%:P * 'X) * ppoly R p.
Proof. by rewrite /plin ppolyD /= !ppolyZ; ring. Qed.

Lemma bpev_lin a b l x : bpev (blin a b l) x = ((zr R a)%:P + (zr R b)%:P * 'X) * bpev l x.
Proof.
have mapE c : bpev (List.map (pscale c) l) x = (zr R c)%:P * bpev l x.
  by elim: l => [|k l IH]; rewrite /= ?mulr0 // IH pevZ polyCM; ring.
by rewrite /blin bpevD /= !mapE; ring.
Qed.

Lemma bpev_scaled y (w : poly) x : bpev (List.map (fun k => pscale k y) w) x = (pev y x)%:P * ppoly R w.
Proof. by elim: w => [|k w IH]; rewrite /= ?mulr0 // IH pevZ polyCM; ring. Qed.

Section Bmob.
Variables (a b c d : Z) (x : R).
Definition H l : {poly R} := bpev (bmob a b c d l).1 x.
Definition W l : {poly R} := ppoly R (bmob a b c d l).2.

Lemma W_cons k l : W (k :: l) = ((zr R c)%:P + (zr R d)%:P * 'X) * W l.
Proof. by rewrite /W /=; case: bmob => h w /=; rewrite ppoly_lin. Qed.

Lemma H_cons k l : H (k :: l) = (pev k x)%:P * W l + ((zr R a)%:P + (zr R b)%:P * 'X) * H l.
Proof. by rewrite /W /H /=; case: bmob => h w /=; rewrite bpevD bpev_lin bpev_scaled. Qed.

Lemma H_hom l z :
  let u := (zr R a)%:C%C + (zr R b)%:C%C * z in
  let v := (zr R c)%:C%C + (zr R d)%:C%C * z in
  (cpoly (H l)).[z] = (hom (complexes l x) u v).1 /\ (cpoly (W l)).[z] = (hom (complexes l x) u v).2.
Proof.
move=> u v; have hc (y : R) : (cpoly y%:P).[z] = y%:C%C by rewrite /cpoly map_polyC hornerC.
have cM p q : cpoly (p * q : {poly R}) = cpoly p * cpoly q by exact: rmorphM.
have cX : cpoly ('X : {poly R}) = 'X by exact: map_polyX.
elim: l => [|k l [hE wE]].
  by rewrite /H /W /= mulr0 addr0 hc /cpoly map_poly0 horner0.
rewrite W_cons H_cons !(cpolyD, cM) !(hornerD, hornerM) !hc cX hornerX hE wE /=.
by case: hom => h w /=; rewrite /u /v; split; ring.
Qed.

Lemma W_top l : (W l)`_(size l) = zr R d ^+ size l /\ (size (W l) <= (size l).+1)%N.
Proof.
elim: l => [|k l [tE sE]].
  by rewrite /W /= mulr0 addr0 coefC expr0 size_polyC_leq1.
have lE : W (k :: l) = zr R c *: W l + zr R d *: ('X * W l) by rewrite W_cons -!mul_polyC; ring.
rewrite lE; split.
  by rewrite coefD !coefZ coefXM /= tE exprS (nth_default _ sE) mulr0 add0r.
apply/leq_sizeP => j /= lj; rewrite coefD !coefZ coefXM; case: j lj => // j lj /=.
by rewrite !nth_default ?mulr0 ?addr0 // (leq_trans sE) // ltnW.
Qed.

Lemma H_top l : ('X * H l)`_(size l) = (hom (reals l x) (zr R b) (zr R d)).1 /\ (size (H l) <= size l)%N.
Proof.
elim: l => [|k l [tE sE]]; first by rewrite /H /= mulr0 coef0 size_poly0.
have lE : H (k :: l) = pev k x *: W l + (zr R a *: H l + zr R b *: ('X * H l)).
  by rewrite H_cons -!mul_polyC; ring.
have [wE sW] := W_top l; rewrite lE; split.
  rewrite coefXM /= !coefD !coefZ tE wE (nth_default _ sE) mulr0 add0r.
  have := hom_w (reals l x) (zr R b) (zr R d); rewrite size_map.
  by case: hom => h w /= ->.
apply/leq_sizeP => j /= lj; rewrite !coefD !coefZ coefXM; case: j lj => // j lj /=.
rewrite (nth_default _ (leq_trans sW lj)) (nth_default _ (leq_trans sE (ltnW lj))).
by rewrite (nth_default _ (leq_trans sE _)) // !mulr0 !addr0.
Qed.
End Bmob.

Lemma length_padd (p q : poly) : length (padd p q) = maxn (length p) (length q).
Proof.
elim: p q => [|k p IH] [|m q] //=; rewrite ?max0n ?maxn0 //.
by rewrite IH maxnSS.
Qed.

Lemma length_badd (p q : bipoly) : length (badd p q) = maxn (length p) (length q).
Proof.
elim: p q => [|k p IH] [|m q] //=; rewrite ?max0n ?maxn0 //.
by rewrite IH maxnSS.
Qed.

Lemma length_bmob a b c d l :
  length (bmob a b c d l).1 = length l /\ length (bmob a b c d l).2 = (length l).+1.
Proof.
elim: l => //= k l; case: bmob => h w /= [hE wE].
rewrite /blin /plin !length_badd !length_padd /= !map_length hE wE; split.
  by rewrite (maxn_idPr (leqnSn _)) maxnn.
by rewrite (maxn_idPr (leqnSn _)).
Qed.

(** ** The circle of radius r *)

Lemma nth_last_map l x n : length l = n.+1 -> last 0 (complexes l x) = ((bpev l x)`_n)%:C%C.
Proof.
move=> ln; rewrite coef_bpev; elim: l n ln => // k [|m l] IH [|n] //= [ln].
by rewrite -(IH n) //= ln.
Qed.

Lemma C0 (y : R) : (y%:C%C == 0 :> C) = (y == 0).
Proof. by rewrite eq_complex /= eqxx andbT. Qed.

Lemma size_l l : size l = length l.
Proof. by []. Qed.

Lemma hom_infinite_l l x n u : length l = n.+1 ->
  (hom (complexes l x) u 0).1 = ((bpev l x)`_n)%:C%C * u ^+ n.
Proof.
move=> ln; have := nth_last_map x ln; case: l ln => // k l [ln] <-.
by rewrite [complexes _ _]/= hom_infinite size_map size_l ln.
Qed.

Lemma hom_real l x (u v : R) :
  (hom (complexes l x) u%:C%C v%:C%C).1 = (hom (reals l x) u v).1%:C%C
  /\ (hom (complexes l x) u%:C%C v%:C%C).2 = (hom (reals l x) u v).2%:C%C.
Proof.
elim: l => [|k l] /=; first by rewrite !rmorph0 !rmorph1.
case: hom => h w; case: hom => h' w' /= [-> ->].
by rewrite !(rmorphM, rmorphD).
Qed.

(** The leading coefficient after the substitution. *)
Lemma H_lead a b c d l x n : length l = n.+1 ->
  ((H a b c d x l)`_n)%:C%C = (hom (complexes l x) (zr R b)%:C%C (zr R d)%:C%C).1.
Proof.
move=> ln; have [top _] := H_top a b c d x l; have [-> _] := hom_real l x (zr R b) (zr R d).
by rewrite -top coefXM size_l ln.
Qed.

Lemma H_size a b c d l x n : length l = n.+1 -> (size (H a b c d x l) <= n.+1)%N.
Proof. by move=> ln; have [_] := H_top a b c d x l; rewrite size_l ln. Qed.

Lemma disc_ok (q : Q) l x n : length l = n.+1 -> Z.ltb 0 (Qnum q) ->
  all_in (Disc q) n (bpev l x) <-> stable n (bpev (to_disc (Disc q) l) x).
Proof.
move=> ln; rewrite (zr_gt0 R) => u0; set u := zr R (Qnum q) in u0; set v := pr R (Qden q).
have v0 : 0 < v := pr_gt0 R _.
rewrite /to_disc -/(H _ _ _ _ _ _); set h := H _ _ _ _ _ _.
have lead : (h`_n == 0) = ((bpev l x)`_n == 0).
  by rewrite -C0 (H_lead _ _ _ _ _ ln) /= (hom_infinite_l _ _ ln) mulf_eq0 expf_eq0 !C0 (gt_eqF u0) andbF orbF.
have vC : v%:C%C != 0 :> C by rewrite C0 gt_eqF.
have uC : u%:C%C != 0 :> C by rewrite C0 gt_eqF.
have rootE z : root (cpoly h) z = root (cpoly (bpev l x)) (u%:C%C * z / v%:C%C).
  have [e _] := H_hom 0 (Qnum q) (Zpos (Qden q)) 0 x l z.
  rewrite root_value rootE e /= mul0r addr0 add0r hom_eq0 //.
have normE z : inside (Disc q) (u%:C%C * z / v%:C%C) = (`|z| < 1).
  rewrite /inside qrE rmorphM fmorphV !normrM normfV !norm_real (gtr0_norm u0) (gtr0_norm v0).
  by rewrite ltr_pmul2r ?invr_gt0 ?ltcR // gtr_pmulr // ltcR.
split=> [[pn ins]|[_ hn ins]]; split; rewrite ?H_size ?lead // -?lead //.
  by move=> z; rewrite rootE => /ins; rewrite normE.
move=> z pz; have zE : z = u%:C%C * (z * v%:C%C / u%:C%C) / v%:C%C.
  by rewrite [u%:C%C * _]mulrC mulfVK // mulfK.
by rewrite zE normE ins // rootE -zE.
Qed.

(** ** The half plane left of -a *)

Lemma left_norm z (v : R) : 0 < v -> (`|z + v%:C%C| < `|v%:C%C - z|) = (complex.Re z < 0).
Proof.
move=> v0; rewrite -(ltr_pexpn2r (ltn0Sn 1)) ?nnegrE // -!add_Re2_Im2 ltcR.
case: z => a b /=; rewrite addr0 sub0r sqrrN ltr_add2r -subr_gt0.
have -> : (v - a) ^+ 2 - (a + v) ^+ 2 = (4%:R * v) * - a by ring.
by rewrite pmulr_rgt0 ?oppr_gt0 // mulr_gt0 ?ltr0n.
Qed.

Lemma left_ok (q : Q) l x n : length l = n.+1 ->
  all_in (Left q) n (bpev l x) <-> stable n (bpev (to_disc (Left q) l) x).
Proof.
move=> ln; set u := zr R (Qnum q); set v := pr R (Qden q); have v0 : 0 < v := pr_gt0 R _.
rewrite /to_disc -/(H _ _ _ _ _ _); set h := H _ _ _ _ _ _.
have vC : v%:C%C != 0 :> C by rewrite C0 gt_eqF.
have bE : zr R (Zpos (Qden q) - Qnum q) = v - u by rewrite zrD zrN.
have aE : zr R (- (Zpos (Qden q) + Qnum q)) = - (v + u) by rewrite zrN zrD.
have insideE z : inside (Left q) z = (complex.Re (z * v%:C%C + u%:C%C) < 0).
  have -> : complex.Re (z * v%:C%C + u%:C%C) = complex.Re z * v + u.
    by case: z => a b /=; rewrite mulr0 subr0.
  have e : (complex.Re z * v + u < 0) = (complex.Re z < - qr R q).
    by rewrite -ltr_subr_addr sub0r qrE -mulNr ltr_pdivl_mulr.
  rewrite e /inside qrE; case: (Qnum q) => //=; by rewrite mul0r oppr0.
pose uz z : C := - (v + u)%:C%C + (v - u)%:C%C * z; pose vz z : C := v%:C%C + v%:C%C * z.
have vzE z : vz z = v%:C%C * (1 + z) by rewrite /vz mulrDr mulr1.
have hE z : root (cpoly h) z = ((hom (complexes l x) (uz z) (vz z)).1 == 0).
  by have [e _] := H_hom (- (Zpos (Qden q) + Qnum q)) (Zpos (Qden q) - Qnum q) (Zpos (Qden q)) (Zpos (Qden q)) x l z;
     rewrite rootE e aE bE rmorphN.
have rootE z : 1 + z != 0 -> root (cpoly h) z = root (cpoly (bpev l x)) (uz z / vz z).
  by move=> z1; rewrite hE root_value hom_eq0 // vzE mulf_neq0.
have yE z : 1 + z != 0 -> uz z / vz z * v%:C%C + u%:C%C = v%:C%C * (z - 1) / (1 + z).
  move=> z1; apply: (mulIf z1); rewrite vzE mulrDl [RHS]mulfVK //.
  rewrite -[uz z / _ * v%:C%C * _]mulrA mulfVK ?mulf_neq0 //.
  by rewrite /uz !(rmorphD, rmorphN) /=; ring.
have insE z : 1 + z != 0 -> inside (Left q) (uz z / vz z) = (`|z| < 1).
  move=> z1; rewrite insideE yE // -(left_norm _ v0).
  have k0 : 0 < `|2%:R * v%:C%C / (1 + z)| by rewrite normr_gt0 !mulf_neq0 ?invr_eq0 // pnatr_eq0.
  have -> : v%:C%C - v%:C%C * (z - 1) / (1 + z) = 2%:R * v%:C%C / (1 + z).
    by apply: (mulIf z1); rewrite mulrDl mulNr !(divfK z1); ring.
  have -> : v%:C%C * (z - 1) / (1 + z) + v%:C%C = 2%:R * v%:C%C / (1 + z) * z.
    by apply: (mulIf z1); rewrite mulrDl (divfK z1) mulrAC (divfK z1); ring.
  by rewrite [in LHS]normrM gtr_pmulr.
have lead : (h`_n == 0) = root (cpoly (bpev l x)) ((v - u)%:C%C / v%:C%C).
  by rewrite -C0 (H_lead _ _ _ _ _ ln) bE root_value hom_eq0.
have atN1 : root (cpoly h) (-1) = ((bpev l x)`_n == 0).
  rewrite hE vzE subrr mulr0 (hom_infinite_l _ _ ln) mulf_eq0 expf_eq0 C0.
  have -> : uz (-1) = - (v + v)%:C%C by rewrite /uz !(rmorphD, rmorphN) /=; ring.
  by rewrite oppr_eq0 C0 (gt_eqF (addr_gt0 v0 v0)) andbF orbF.
have zN1 z : (1 + z == 0) = (z == -1) by rewrite addrC addr_eq0.
split=> [[pn ins]|[_ hn ins]]; split; rewrite ?H_size //.
- rewrite lead; apply/negP => /ins; rewrite insideE mulfVK // -rmorphD /= subrK.
  by rewrite ltNge ltW.
- move=> z; case: (eqVneq z (-1)) => [->|z1]; first by rewrite atN1 (negPf pn).
  by rewrite rootE ?zN1 // => /ins; rewrite insE // zN1.
- by apply/negP; rewrite -atN1 => /ins; rewrite normrN1 ltxx.
- move=> s ps; pose w := v%:C%C - (s * v%:C%C + u%:C%C).
  have w0 : w != 0.
    apply: contra hn; rewrite lead subr_eq0 => /eqP e.
    have -> : (v - u)%:C%C / v%:C%C = s; last exact: ps.
    by apply: (mulIf vC); rewrite divfK // rmorphB /= {1}e addrK.
  pose z := (s * v%:C%C + u%:C%C + v%:C%C) / w.
  have z1E : 1 + z = 2%:R * v%:C%C / w.
    by apply: (mulIf w0); rewrite mulrDl !(divfK w0) mul1r /w; ring.
  have z1 : 1 + z != 0 by rewrite z1E !mulf_neq0 ?invr_eq0 // pnatr_eq0.
  have sE : uz z / vz z = s.
    have zw : z * w = s * v%:C%C + u%:C%C + v%:C%C by rewrite mulfVK.
    apply: (mulIf (mulf_neq0 vC z1)); rewrite -vzE mulfVK ?vzE ?mulf_neq0 //.
    have z1w : (1 + z) * w = 2%:R * v%:C%C by rewrite z1E divfK.
    apply: (mulIf w0); rewrite /uz.
    have -> : s * (v%:C%C * (1 + z)) * w = s * v%:C%C * ((1 + z) * w) by ring.
    have -> : (- (v + u)%:C%C + (v - u)%:C%C * z) * w = - (v + u)%:C%C * w + (v - u)%:C%C * (z * w) by ring.
    by rewrite z1w zw !(rmorphD, rmorphN) /= /w; ring.
  by rewrite -sE insE // ins // rootE // sE.
Qed.

(** The polynomial computed for the unit circle answers the question about the region. *)
Theorem to_disc_ok (r : region) l x n : length l = n.+1 -> region_ok r ->
  all_in r n (bpev l x) <-> stable n (bpev (to_disc r l) x).
Proof. by case: r => q ln ok; [exact: (disc_ok x ln ok) | exact: (left_ok q x ln)]. Qed.

Lemma length_to_disc r l : length (to_disc r l) = length l.
Proof. by case: r => q; apply: proj1 (length_bmob _ _ _ _ l). Qed.

Lemma length_bprim l : length (bprim l) = length l.
Proof. by rewrite /bprim; case: ifP => // _; rewrite map_length. Qed.

(** ** A checked answer for a polynomial *)

Lemma check_poly_conditions fuel r l ans : check_poly fuel r l ans -> exists cs n,
  [/\ length l = n.+2,
      check_pieces fuel cs (lower ans) (upper ans) (starts ans) (pieces ans)
    & forall x, all_in r n.+1 (bpev l x) <-> holds cs x].
Proof.
case/andP => ok; case E: conditions => [cs|//] H; have [m [ls [len _ _]]] := conditions_inv E.
rewrite length_bprim length_to_disc in len; exists cs, m; split=> // x.
rewrite (to_disc_ok x len ok) -(conditions_ok x E) length_bprim length_to_disc len /=.
by have [k k0 ->] := bpev_prim (to_disc r l) x; apply: (stableZ _ _ (lt0r_neq0 k0)).
Qed.

End Region.
