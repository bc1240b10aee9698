(** The computed table and the sign tests mean what they should. *)

From Coq Require Import ZArith QArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import polyrcf.
From mathcomp Require Import ring.
From Jurist Require Import Compute Jury Real.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Arguments Z.eqb : simpl never.
Arguments Z.ltb : simpl never.
Arguments Z.leb : simpl never.
Arguments Z.mul : simpl never.
Arguments Z.add : simpl never.
Arguments Z.opp : simpl never.
Arguments Z.sub : simpl never.

(** ** Lists *)

Lemma length_map2 (A B D : Type) (f : A -> B -> D) l m :
  length l = length m -> length (map2 f l m) = length l.
Proof. by elim: l m => [|a l IH] [|b m] //= [/IH->]. Qed.

Lemma nth_map2 (A B D : Type) (f : A -> B -> D) l m k a b d :
  length l = length m -> (k < length l)%N ->
  List.nth k (map2 f l m) d = f (List.nth k l a) (List.nth k m b).
Proof. by elim: l m k => [|u l IH] [|v m] [|k] //= [e]; rewrite ltnS => /IH->. Qed.

Lemma nth_tl (A : Type) (l : list A) k d : List.nth k (tl l) d = List.nth k.+1 l d.
Proof. by case: l => [|a l] //=; case: k. Qed.

Lemma length_tl (A : Type) (l : list A) : length (tl l) = (length l).-1.
Proof. by case: l. Qed.

Lemma last_nth (A : Type) (l : list A) d : List.last l d = List.nth (length l).-1 l d.
Proof. by elim: l => [|a [|b l] IH] //=; rewrite -/(List.last (b :: l) d) IH. Qed.

Lemma hd_nth (A : Type) (l : list A) d : List.hd d l = List.nth 0 l d.
Proof. by case: l. Qed.

Lemma length_all2 (A B : Type) (f : A -> B -> bool) l m : all2 f l m -> length l = length m.
Proof. by elim: l m => [|a l IH] [|b m] //= /andP[_ /IH->]. Qed.

Section Sound.
Variable R : rcfType.
Implicit Types (p F : poly) (q : Q) (l r : bipoly) (x t K : R).

(** ** The table *)

Lemma length_jrow l : length (jrow l) = (length l).-1.
Proof. by rewrite length_map2 !length_tl ?rev_length. Qed.

Lemma bpev_jrow l x n : length l = n.+2 -> bpev (jrow l) x = row n.+1 (bpev l x).
Proof.
move=> ln; apply/polyP => k; rewrite coef_row !coef_bpev.
case: ltnP => kn; last first.
  rewrite List.nth_overflow //; apply/ssrnat.leP.
  by rewrite length_jrow ln.
rewrite (nth_map2 _ nil nil) ?length_tl ?rev_length ?ln // !nth_tl pevB !pevM.
rewrite List.rev_nth; last by apply/ssrnat.ltP; rewrite ln.
by rewrite last_nth hd_nth ln.
Qed.

Lemma divide_row_ok f r (q : bipoly) x : divide_row f r = Some q ->
  length q = length r /\ exists2 c : R, 0 < c & bpev r x = (c * pev f x) *: bpev q x.
Proof.
rewrite /divide_row; case: ifP => // /andP[c0 H] [<-].
split; first by rewrite (length_all2 H).
by exists (zr R (bcontent (List.map (fun y => pdiv y f) r))); rewrite -?zr_gt0 // -(bpev_all2 x H).
Qed.

Definition holds (cs : list poly) x : bool := forallb (fun p => 0 < pev p x) cs.

Lemma rowZ n (c : R) (P : {poly R}) : row n (c *: P) = c ^+ 2 *: row n P.
Proof.
apply/polyP => k; rewrite coefZ !coef_row !coefZ; case: ifP => _; last by rewrite mulr0.
by ring.
Qed.

Lemma innerZ n (c : R) (P : {poly R}) : c != 0 -> inner n (c *: P) <-> inner n P.
Proof.
elim: n c P => [|[|n] IH] c P c0 //.
have E Q : inner n.+2 Q = (0 < (row n.+2 Q)`_n.+1 /\ inner n.+1 (row n.+2 Q)) by [].
rewrite !E rowZ IH ?expf_neq0 // coefZ pmulr_rgt0 // exprn_even_gt0 //.
Qed.

Lemma leads_ok n (f g : poly) l ls x : length l = n.+2 -> leads n f g l = Some ls ->
  0 < pev f x -> 0 < pev g x -> inner n.+1 (bpev l x) <-> holds ls x.
Proof.
elim: n f g l ls => [|n IH] f g l ls ln; first by case=> <-.
rewrite [leads _ _ _ _]/=; case D: divide_row => [q|//]; case L: leads => [rest|//] [<-] f0 g0.
have [lq [c c0 rE]] := divide_row_ok x D.
have lq2 : length q = n.+2 by rewrite lq length_jrow ln.
have k0 : 0 < c * pev f x by rewrite mulr_gt0.
have Z := innerZ n.+1 (bpev q x) (lt0r_neq0 k0).
have E P : inner n.+2 P = (0 < (row n.+2 P)`_n.+1 /\ inner n.+1 (row n.+2 P)) by [].
rewrite E -(bpev_jrow x ln) rE coefZ pmulr_rgt0 // coef_bpev last_nth lq2 /=.
split=> [[lead inn]|/andP[lead rest_ok]]; have [d d0 dE] := pev_prim (List.nth n.+1 q nil) x.
  rewrite /holds /= lead /=; apply/(IH _ _ _ _ lq2 L) => //; last by apply/Z.
  by rewrite last_nth lq2 /= -(pmulr_rgt0 _ d0) -dE.
split=> //; apply/Z; apply/(IH _ _ _ _ lq2 L) => //.
by rewrite last_nth lq2 /= -(pmulr_rgt0 _ d0) -dE.
Qed.

Lemma conditions_inv l cs : conditions l = Some cs ->
  exists m ls, [/\ length l = m.+2, leads m [:: Zpos xH] [:: Zpos xH] l = Some ls
    & cs = pmul (List.last l nil) (at_one l)
        :: pmul (List.last l nil) (if Nat.odd m.+1 then popp (at_minus_one l) else at_minus_one l) :: ls].
Proof.
case: l => [|a [|b l]] //; rewrite /conditions; case L: leads => [ls|//] [<-].
by exists (length l), ls; split.
Qed.

Lemma Nat_odd n : Nat.odd n = odd n.
Proof. by elim: n => // k; rewrite Nat.odd_succ -Nat.negb_odd => ->; rewrite oddS. Qed.

Lemma Nat_even n : Nat.even n = ~~ odd n.
Proof. by rewrite -Nat.negb_odd Nat_odd. Qed.

(** Where the table can be computed, its conditions say "stable". *)
Theorem conditions_ok l cs x : conditions l = Some cs ->
  stable (length l).-1 (bpev l x) <-> holds cs x.
Proof.
case/conditions_inv => m [ls [ln L ->]].
have one : pev [:: Zpos xH] x = 1 by rewrite /= mulr0 addr0.
have LO := @leads_ok _ _ _ _ _ x ln L; rewrite one ltr01 in LO; have {}LO := LO isT isT.
have IC := inner_criterion (_ : (size (bpev l x) <= m.+2)%N); rewrite -{1}ln size_bpev in IC.
have {}IC := IC isT.
rewrite ln /= !pevM bpev_one last_nth ln /= -/(holds ls x).
have -> : pev (if Nat.odd m.+1 then popp (at_minus_one l) else at_minus_one l) x
          = (-1) ^+ m.+1 * (bpev l x).[-1].
  rewrite -signr_odd -bpev_minus_one Nat_odd.
  by case: odd; rewrite ?pevN ?expr1 ?expr0 ?mulN1r ?mul1r.
rewrite -coef_bpev; split=> [/IC[inn -> ->]|/andP[p1 /andP[m1 inn]]]; first by rewrite /=; apply/LO.
by apply/IC; split=> //; apply/LO.
Qed.

(** ** Signs on an interval *)

Definition between (a b : pt) K : bool :=
  (zr R a.1 < zr R a.2 * K) && (zr R b.2 * K < zr R b.1).

Lemma pmob_ok a b c d p K t D : D = zr R c + zr R d * t -> 0 < D -> K * D = zr R a + zr R b * t ->
  0 < pev (pmob a b c d p).2 t /\
  pev (pmob a b c d p).1 t * D = pev p K * pev (pmob a b c d p).2 t.
Proof.
move=> DE D0 KD; elim: p => [|y p] /=; first by rewrite !mul0r mulr0 addr0 ltr01.
case: pmob => h w /= [w0 hw]; rewrite pev_lin -DE mulr_gt0 //; split=> //.
rewrite pevD pevZ pev_lin -KD mulrDl -[K * D * _ * D]mulrA hw; ring.
Qed.

Lemma nonneg_pev p t : 0 < t -> forallb (Z.leb 0) p -> 0 <= pev p t.
Proof.
move=> t0; elim: p => //= a p IH /andP[]; rewrite (zr_ge0 R) => a0 /IH p0.
by rewrite addr_ge0 // mulr_ge0 // ltW.
Qed.

Lemma pos_pev p t : 0 < t -> forallb (Z.leb 0) p -> Z.ltb 0 (List.last p Z0) -> 0 < pev p t.
Proof.
move=> t0; elim: p => [|a [|b p] IH]; rewrite ?(zr_gt0 R) ?ltxx //.
  by rewrite /= mulr0 addr0.
move=> /andP[a0 p0] l0; have := IH p0; rewrite (zr_gt0 R) => /(_ l0) p1.
have -> : pev (a :: b :: p) t = zr R a + t * pev (b :: p) t by [].
by rewrite ltr_paddl ?mulr_gt0 // -zr_ge0.
Qed.

Lemma pev_at1 p : pev p (1 : R) = zr R (List.fold_right Z.add Z0 p).
Proof. by elim: p => //= a p ->; rewrite zrD mul1r. Qed.

Lemma ray_pos_ok fuel p t : ray_pos fuel p -> 0 < t -> 0 < pev p t.
Proof.
elim: fuel p t => [|fuel IH] p t; rewrite -(pev_trim p t) /=; case E: (ptrim p) => [|a q] //.
  by case: ifP => // /andP[_ l0]; case: ifP => // nn _ t0; apply: pos_pev.
case: ifP => // /andP[_ l0]; case: ifP => [nn _ t0|_]; first exact: pos_pev.
case: ifP => // s0; case: ifP => // lo hi t0; case: (ltgtP t 1) => t1.
- have t2 : 0 < 1 - t by rewrite subr_gt0.
  have u0 : 0 < t / (1 - t) by rewrite divr_gt0.
  have D1 : 1 + t / (1 - t) = (1 - t)^-1.
    by rewrite -{1}(divff (lt0r_neq0 t2)) -mulrDl subrK mul1r.
  have D0 : 0 < (1 - t)^-1 by rewrite invr_gt0.
  have [] := @pmob_ok 0 1 1 1 (a :: q) t (t / (1 - t)) (1 - t)^-1.
  + by rewrite /= mul1r D1.
  + exact: D0.
  + by rewrite /= mul1r add0r.
  move=> w0 e; have := IH _ _ lo u0; rewrite -(pmulr_lgt0 _ D0) e pmulr_lgt0 //.
- have u0 : 0 < t - 1 by rewrite subr_gt0.
  have [] := @pmob_ok 1 1 1 0 (a :: q) t (t - 1) 1.
  + by rewrite /= mul0r addr0.
  + exact: ltr01.
  + by rewrite /= mulr1 mul1r addrC subrK.
  move=> w0 e; have := IH _ _ hi u0; rewrite -[pev _ _]mulr1 e pmulr_lgt0 //.
by rewrite t1 pev_at1 -zr_gt0.
Qed.

Lemma pmob_between a b p K : proper a b -> between a b K ->
  exists t D w, [/\ 0 < t, 0 < D, 0 < w & pev (pmob a.1 b.1 a.2 b.2 (ptrim p)).1 t * D = pev p K * w].
Proof.
case: a b => a c [b d]; rewrite /proper /between /= => /andP[/andP[c0 d0] m0] /andP[lo hi].
rewrite -subr_gt0 in lo; rewrite -subr_gt0 in hi.
set s := zr R b - zr R d * K in hi *; set t := (zr R c * K - zr R a) / s.
have s0 : s != 0 by rewrite gt_eqF.
have m1 : 0 < zr R b * zr R c - zr R a * zr R d by rewrite -!zrM -zrN -zrD -zr_gt0.
have t0 : 0 < t by rewrite divr_gt0.
have tE : t * s = zr R c * K - zr R a by rewrite mulfVK.
have e : (zr R c + zr R d * t) * s = zr R b * zr R c - zr R a * zr R d.
  by rewrite mulrDl -[zr R d * t * s]mulrA tE /s; ring.
have D0 : 0 < zr R c + zr R d * t by rewrite -(pmulr_lgt0 _ hi) e.
have KD : K * (zr R c + zr R d * t) = zr R a + zr R b * t.
  by apply: (mulIf s0); rewrite -mulrA e mulrDl -[zr R b * t * s]mulrA tE /s; ring.
have [w0 h] := @pmob_ok a b c d (ptrim p) K t _ erefl D0 KD.
by exists t, (zr R c + zr R d * t), (pev (pmob a b c d (ptrim p)).2 t); rewrite h pev_trim.
Qed.

Lemma over_den_ok D p K : 0 < zr R D ->
  0 < zr R (over_den D p).2 /\
  pev (over_den D p).1 (zr R D * K) * zr R D = pev p K * zr R (over_den D p).2.
Proof.
move=> D0; elim: p => [|y p] /=; first by rewrite !mul0r ltr01.
case: over_den => q w /= [w0 e]; rewrite !zrM mulr_gt0 //; split=> //.
by rewrite mulrDl -[_ * _ * pev q _ * _]mulrA e; ring.
Qed.

Lemma shift_ok a p t : pev (shift a p) t = pev p (zr R a + t).
Proof.
elim: p => // y p IH; have -> : shift a (y :: p) = padd [:: y] (plin a 1 (shift a p)) by [].
by rewrite pevD pev_lin IH /= mulr0 addr0 mul1r.
Qed.

Lemma stretch_ok w m p t : pev (stretch w m p) t = zr R m * pev p (zr R w * t).
Proof. by elim: p m => [|y p IH] m; rewrite /= ?mulr0 // IH !zrM; ring. Qed.

Lemma rev_ok p t : t != 0 -> pev (List.rev p) t * t = t ^+ length p * pev p t^-1.
Proof.
move=> t0; elim: p => [|y p IH] /=; first by rewrite mul0r mulr0.
have app (q : poly) z : pev (q ++ [:: z])%list t = pev q t + t ^+ length q * zr R z.
  by elim: q => [|k q /= ->]; rewrite /= ?mulr0 ?addr0 ?mul1r ?add0r // exprS; ring.
rewrite app rev_length mulrDl IH exprS; move: (pev p _) (t ^+ _) => P m.
by field.
Qed.

(** The interval as the ray t > 0. *)
Lemma mob_ok a b p K : proper a b -> between a b K ->
  exists t D w, [/\ 0 < t, 0 < D, 0 < w & pev (mob a b p) t * D = pev p K * w].
Proof.
move=> ab abK; have := pmob_between p ab abK; case: a b ab abK => [x c] [y d] _ /andP[/= lo hi].
rewrite /mob => /= general; case: ifP => [/andP[]|_].
  rewrite (zr_gt0 R) => c0 /Z.eqb_eq d0; have [w0 e] := over_den_ok (ptrim p) K c0.
  exists (zr R c * K - zr R x), (zr R c), (zr R (over_den c (ptrim p)).2).
  by rewrite subr_gt0 lo c0 w0 shift_ok addrC subrK e pev_trim.
case: ifP => [/andP[/andP[/andP[/andP[]]]]|_ //].
set D := Z.lcm c d; set u := Z.mul x (Z.div D c); set v := Z.mul y (Z.div D d).
rewrite !(zr_gt0 R) => c0 d0 D0 /(eqb_zr R) uE /(eqb_zr R) vE.
have {}uE : zr R u * zr R c = zr R x * zr R D by rewrite -zrM -[RHS]zrM.
have {}vE : zr R v * zr R d = zr R y * zr R D by rewrite -zrM -[RHS]zrM.
have uK : zr R u < zr R D * K.
  by rewrite -(ltr_pmul2r c0) uE [zr R x * _]mulrC -mulrA ltr_pmul2l // [K * _]mulrC.
have vK : zr R D * K < zr R v.
  by rewrite -(ltr_pmul2r d0) vE [zr R y * _]mulrC -mulrA ltr_pmul2l // [K * _]mulrC.
have w0 : 0 < zr R D * K - zr R u by rewrite subr_gt0.
have uv : 0 < zr R v - zr R u by rewrite subr_gt0 (lt_trans uK).
pose t := (zr R v - zr R u) / (zr R D * K - zr R u).
have t0 : 0 < t by rewrite divr_gt0.
have t1 : 0 < t - 1 by rewrite subr_gt0 ltr_pdivl_mulr // mul1r ltr_add2r.
have [W0 e] := over_den_ok (ptrim p) K D0; set q := (over_den D (ptrim p)).1 in e *.
set g := stretch (v - u) 1 (shift u q).
exists (t - 1), (t * zr R D), (t ^+ length g * zr R (over_den D (ptrim p)).2).
rewrite mulr_gt0 // mulr_gt0 ?exprn_gt0 //; split=> //.
have -> : pev (shift 1 (List.rev g)) (t - 1) = pev (List.rev g) t by rewrite shift_ok /= addrC subrK.
have gE : pev g t^-1 = pev q (zr R D * K).
  by rewrite /g stretch_ok mul1r shift_ok zrD zrN /t invf_div mulrCA divff ?gt_eqF // mulr1 addrC subrK.
have -> : pev (List.rev g) t * (t * zr R D) = t ^+ length g * (pev g t^-1 * zr R D).
  by rewrite mulrA rev_ok ?gt_eqF // -mulrA.
by rewrite gE e pev_trim mulrCA.
Qed.

Lemma pos_on_ok fuel a b p K : pos_on fuel a b p -> between a b K -> 0 < pev p K.
Proof.
case/andP => pr pos ab; have [t [D [w [t0 D0 w0 e]]]] := mob_ok p pr ab.
by rewrite -(pmulr_lgt0 _ w0) -e mulr_gt0 // (ray_pos_ok pos).
Qed.

Lemma nonzero_on_ok fuel a b p K : nonzero_on fuel a b p -> between a b K -> pev p K != 0.
Proof.
rewrite /nonzero_on; case: ifP => [H _ ab|_ H ab]; have := pos_on_ok H ab; first by move/gt_eqF->.
by rewrite pevN oppr_gt0 => /lt_eqF->.
Qed.

Lemma nonpos_pev p t : 0 < t -> forallb (fun y => Z.leb y 0) p -> pev p t <= 0.
Proof.
move=> t0; elim: p => //= a p IH /andP[]; rewrite (zr_le0 R) => a0 /IH p0.
by rewrite -oppr_ge0 opprD addr_ge0 ?oppr_ge0 // pmulr_rle0.
Qed.

Lemma nonpos_on_ok a b p K : nonpos_on a b p -> between a b K -> pev p K <= 0.
Proof.
case/andP => pr nonpos ab; have [t [D [w [t0 D0 w0 e]]]] := mob_ok p pr ab.
by rewrite -(pmulr_lle0 _ w0) -e pmulr_lle0 // nonpos_pev.
Qed.

Lemma phom_ok (q : Q) p :
  0 < zr R (phom (Qnum q) (Zpos (Qden q)) p).2 /\
  zr R (phom (Qnum q) (Zpos (Qden q)) p).1 * pr R (Qden q)
  = pev p (qr R q) * zr R (phom (Qnum q) (Zpos (Qden q)) p).2.
Proof.
have d0 := pr_gt0 R (Qden q).
have e : zr R (Qnum q) = qr R q * pr R (Qden q) by rewrite qrE mulfVK ?gt_eqF.
elim: p => [|y p] /=; first by rewrite !mul0r ltr01.
case: phom => v w /= [w0 vw]; rewrite !zrM !zrD !zrM /= mulr_gt0 //; split=> //.
rewrite mulrDl -[_ * zr R v * _]mulrA vw e; ring.
Qed.

Lemma pval_gt0 q p : Z.ltb 0 (pval q p) = (0 < pev p (qr R q)).
Proof.
have [w0 e] := phom_ok q p.
by rewrite (zr_gt0 R) -(pmulr_lgt0 _ (pr_gt0 R (Qden q))) e pmulr_lgt0.
Qed.

Lemma pval_le0 q p : Z.leb (pval q p) 0 = (pev p (qr R q) <= 0).
Proof.
have [w0 e] := phom_ok q p.
by rewrite (zr_le0 R) -(pmulr_lle0 _ (pr_gt0 R (Qden q))) e pmulr_lle0.
Qed.

Lemma pval_lt0 q p : Z.ltb (pval q p) 0 = (pev p (qr R q) < 0).
Proof.
have [w0 e] := phom_ok q p.
by rewrite (zr_lt0 R) -(pmulr_llt0 _ (pr_gt0 R (Qden q))) e pmulr_llt0.
Qed.

(** ** The conditions on an interval *)

Lemma in_on_ok fuel cs a b K : in_on fuel cs a b -> between a b K -> holds cs K.
Proof. by move=> H ab; elim: cs H => //= c cs IH /andP[/pos_on_ok-> // /IH->]. Qed.

Lemma out_on_ok cs a b K : out_on cs a b -> between a b K -> holds cs K = false.
Proof.
move=> H ab; elim: cs H => //= c cs IH; rewrite /out_on /=; case np: (nonpos_on a b c) => H; last by rewrite (IH H) andbF.
by have := nonpos_on_ok np ab; rewrite leNgt => /negPf->.
Qed.

Lemma in_at_ok cs q : in_at cs q = holds cs (qr R q).
Proof. by elim: cs => //= c cs <-; rewrite pval_gt0. Qed.

Lemma out_at_ok cs q : out_at cs q = ~~ holds cs (qr R q).
Proof.
rewrite /out_at; elim: cs => //= c cs ->; rewrite pval_le0 negb_and leNgt.
by case: (0 < _).
Qed.

Lemma strip_ok fuel F p K : pev p K = pev F K ^+ (strip fuel F p).1 * pev (strip fuel F p).2 K.
Proof.
elim: fuel p => [|fuel IH] p /=; first by rewrite mul1r.
case: ifP => [/andP[_ /(pev_eq K) e]|_]; last by rewrite mul1r.
have := IH (pdiv p F); case: strip => m h /= {}IH.
by rewrite e pevM IH exprS mulrA.
Qed.

(** What an edge says. *)
Definition edge_side (s : side) F K : bool :=
  match s with Rising => 0 < pev F K | Falling => pev F K < 0 | Touching => pev F K != 0 end.

Lemma holds_all cs K : holds cs K <-> forall c, List.In c cs -> 0 < pev c K.
Proof. exact: forallb_forall. Qed.

Lemma edge_ok fuel s cs F a b K : edge fuel s cs F a b -> between (pt_of a) (pt_of b) K ->
  holds cs K = edge_side s F K.
Proof.
case/andP => /forallb_forall H some ab.
have part c : List.In c cs -> pev c K = pev F K ^+ (strip_all F c).1 * pev (strip_all F c).2 K /\
    0 < pev (if (match s with Falling => Nat.odd (strip_all F c).1 | _ => false end)
             then popp (strip_all F c).2 else (strip_all F c).2) K.
  move=> ci; split; first exact: strip_ok.
  have := H _ (in_map (strip_all F) _ _ ci); case: (strip_all F c) => m g /= h; exact: pos_on_ok h ab.
have no c : List.In c cs -> pev c K <= 0 -> holds cs K = false.
  by move=> ci le; apply/negP => /holds_all/(_ c ci); rewrite ltNge le.
case: s H some part => H some part /=.
- case: ltP => F0.
    by apply/holds_all => c /part[-> g0]; rewrite mulr_gt0 // exprn_gt0.
  move/existsb_exists: some => [mg [/in_map_iff[c [<- ci]] od]]; apply: (no c ci).
  have [-> g0] := part c ci; rewrite pmulr_lle0 //.
  by rewrite exprn_odd_le0 // -Nat_odd.
- case: ltP => F0.
    apply/holds_all => c /part[-> ]; rewrite Nat_odd; case: ifP => od.
      by rewrite pevN oppr_gt0 => g0; rewrite nmulr_rgt0 // exprn_odd_lt0.
    by move=> g0; rewrite mulr_gt0 // exprn_even_gt0 ?od // (lt_eqF F0) ?orbT.
  move/existsb_exists: some => [mg [/in_map_iff[c [<- ci]] od]]; apply: (no c ci).
  have [-> ] := part c ci; rewrite od pevN oppr_gt0 => g0.
  by rewrite nmulr_lle0 // exprn_ge0.
- case/andP: some => /forallb_forall ev some; case: eqP => F0 /=.
    move/existsb_exists: some => [mg [/in_map_iff[c [<- ci]] od]]; apply: (no c ci).
    have [-> _] := part c ci; rewrite F0; case: (strip_all F c).1 od => // m _.
    by rewrite expr0n /= mul0r.
  apply/holds_all => c ci; have [-> g0] := part c ci.
  have en : ~~ odd (strip_all F c).1 by have := ev _ (in_map _ _ _ ci); rewrite Nat_even.
  by rewrite mulr_gt0 // exprn_even_gt0 //; apply/orP; right; apply/eqP.
Qed.

(** ** The root between two rational points *)

(** [x] is the only root of [F] between [a] and [b]. *)
Definition only_root F (a b : Q) x : Prop :=
  [/\ pev F x = 0, qr R a < x < qr R b & forall y, qr R a < y < qr R b -> pev F y = 0 -> y = x].

Lemma between_qr a b K : between (pt_of a) (pt_of b) K = (qr R a < K < qr R b).
Proof.
rewrite /between /pt_of /= !qrE ltr_pdivr_mulr ?pr_gt0 // ltr_pdivl_mulr ?pr_gt0 //.
by rewrite ![K * _]mulrC.
Qed.

Lemma isolates_ok fuel F a b : isolates fuel F a b ->
  exists x, [/\ only_root F a b x,
    forall K, qr R a < K < qr R b -> (0 < pev F K) = (x < K),
    forall K, qr R a < K < qr R b -> (pev F K < 0) = (K < x)
  & forall K, qr R a < K < qr R b -> (pev F K == 0) = (K == x)].
Proof.
case/andP => /andP[pos]; rewrite pval_lt0 (pval_gt0) -!horner_ppoly => Fa Fb.
have der : {in `]qr R a, qr R b[, forall y, 0 < (ppoly R F)^`().[y]}.
  move=> y; rewrite in_itv /= => ayb; rewrite -ppoly_deriv horner_ppoly.
  by apply: pos_on_ok pos _; rewrite between_qr.
have ab : qr R a < qr R b.
  rewrite ltNge; apply/negP => ba; case/andP: pos => /andP[/andP[_ _]].
  rewrite (zr_gt0 R) /= zrD zrN !zrM subr_gt0 => pab _; move: ba; rewrite leNgt !qrE.
  by rewrite ltr_pdivr_mulr ?pr_gt0 // mulrAC ltr_pdivl_mulr ?pr_gt0 // pab.
have [x] : {x | x \in `[qr R a, qr R b] & root (ppoly R F) x}.
  by apply: polyrcf.poly_ivt; [apply: ltW | rewrite in_itv /= !ltW].
rewrite in_itv /= => /andP[ax xb] /rootP Fx.
have {}ax : qr R a < x.
  by rewrite lt_neqAle ax andbT; apply: contraTneq Fa => ->; rewrite Fx ltxx.
have {}xb : x < qr R b.
  by rewrite lt_neqAle xb andbT; apply: contraTneq Fb => <-; rewrite Fx ltxx.
have inside y : qr R a < y < qr R b -> y \in `[qr R a, qr R b].
  by case/andP => ay yb; rewrite in_itv /= !ltW.
have xin := inside x; rewrite ax xb in xin; have {}xin := xin isT.
have pos_x K : qr R a < K < qr R b -> (0 < pev F K) = (x < K).
  by move=> /inside Kin; rewrite -horner_ppoly -{1}Fx (leW_mono_in (ler_horner der)).
have neg_x K : qr R a < K < qr R b -> (pev F K < 0) = (K < x).
  by move=> /inside Kin; rewrite -horner_ppoly -{1}Fx (leW_mono_in (ler_horner der)).
have zero_x K : qr R a < K < qr R b -> (pev F K == 0) = (K == x).
  by move=> ayb; rewrite !eq_le !leNgt pos_x // neg_x.
exists x; split=> //; split; first by rewrite -horner_ppoly.
  by rewrite ax.
by move=> y yab /eqP; rewrite zero_x // => /eqP.
Qed.

End Sound.
