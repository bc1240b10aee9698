(** From the checked pieces to the statement: for which values of the parameter the loop is stable. *)

From Coq Require Import ZArith QArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From Jurist Require Import Compute Jury Real Sound.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Answer.
Variable R : rcfType.
Implicit Types (K x : R) (acc : seq (R -> bool)) (st : option (option R)) (a b : option Q).

(** ** The statement

    [say S lower upper ...] goes through the pieces and writes down: there are such limits, each the
    only root of its polynomial between two rational numbers, and for every value of the parameter
    in the domain, [S] holds if and only if it lies between them. *)

(** From a lower limit on; none: from the beginning of the domain. *)
Definition since (lo : option R) K : bool := if lo is Some x then x < K else true.
Definition from_to (lo : option R) (hi : R) K : bool := if lo is Some x then x < K < hi else K < hi.

Fixpoint any acc K : Prop :=
  match acc with
  | [::] => False
  | [:: f] => f K
  | f :: acc' => f K \/ any acc' K
  end.

Definition on_domain (lower upper : option Q) (P : R -> Prop) : Prop :=
  match lower, upper with
  | None, None => forall K, P K
  | Some a, None => forall K, qr R a < K -> P K
  | None, Some b => forall K, K < qr R b -> P K
  | Some a, Some b => forall K, qr R a < K < qr R b -> P K
  end.

Section Say.
Variables (S : R -> Prop) (lower upper : option Q).

Fixpoint say (a : option Q) st acc (ps : list piece) : Prop :=
  match ps with
  | nil => on_domain lower upper (fun K => S K <-> any (if st is Some lo then acc ++ [:: since lo] else acc) K)
  | Along b :: ps' => say (Some b) st acc ps'
  | Up F b :: ps' =>
      if a is Some a then exists x : R, only_root F a b x /\ say (Some b) (Some (Some x)) acc ps' else True
  | Down F b :: ps' =>
      match a, st with
      | Some a, Some lo => exists x : R, only_root F a b x /\ say (Some b) None (acc ++ [:: from_to lo x]) ps'
      | _, _ => True
      end
  | Touch F b :: ps' =>
      match a, st with
      | Some a, Some lo =>
          exists x : R, only_root F a b x /\ say (Some b) (Some (Some x)) (acc ++ [:: from_to lo x]) ps'
      | _, _ => True
      end
  | From :: ps' => if a is Some a then say (Some a) (Some (Some (qr R a))) acc ps' else True
  | Until b :: ps' => if st is Some lo then say (Some b) None (acc ++ [:: from_to lo (qr R b)]) ps' else True
  end.

Definition says (ans : answer) : Prop :=
  say lower (if starts ans then Some None else None) [::] (pieces ans).
End Say.

(** ** It is true where the check succeeds *)

Definition above (a : option Q) K : bool := if a is Some q then qr R q < K else true.
Definition below (b : option Q) K : bool := if b is Some q then K < qr R q else true.

Lemma above_qr (q : Q) K : (zr R (Qnum q) < pr R (Qden q) * K) = (qr R q < K).
Proof. by rewrite qrE ltr_pdivr_mulr ?pr_gt0 // mulrC. Qed.

Lemma below_qr (q : Q) K : (pr R (Qden q) * K < zr R (Qnum q)) = (K < qr R q).
Proof. by rewrite qrE ltr_pdivl_mulr ?pr_gt0 // mulrC. Qed.

Lemma between_ends a b K : between (low_pt a) (high_pt b) K = above a K && below b K.
Proof.
rewrite /between; case: a b => [a|] [b|] /=; rewrite ?above_qr ?below_qr ?mul0r ?ltr01 ?oppr_lt0 ?ltr01 //.
Qed.

Lemma proper_lt a (b : Q) : proper (low_pt a) (pt_of b) -> ~~ above a (qr R b) = false.
Proof.
case: a => [a|] //=; rewrite /proper => /andP[_]; rewrite (zr_gt0 R) /= zrD zrN !zrM subr_gt0 => ab.
by rewrite !qrE ltr_pdivr_mulr ?pr_gt0 // mulrAC ltr_pdivl_mulr ?pr_gt0 // ab.
Qed.

Lemma any_has acc K : any acc K <-> has (fun f => f K) acc.
Proof.
elim: acc => [|f [|g acc] IH]; [by split | by rewrite /= orbF|].
have -> : any (f :: g :: acc) K = (f K \/ any (g :: acc) K) by [].
have -> : has (fun h => h K) (f :: g :: acc) = f K || has (fun h => h K) (g :: acc) by [].
by split=> [[->//|/IH->]|/orP[|/IH]]; rewrite ?orbT; auto.
Qed.

(** The checked statement at one point. *)
Definition onst st K : bool := if st is Some lo then since lo K else false.
Definition on st : bool := if st is Some _ then true else false.
Definition cover acc st K : bool := has (fun f => f K) acc || onst st K.

Variables (cs : list poly) (lower upper : option Q).
Definition dom K : bool := above lower K && below upper K.

(** Up to [a] the conditions hold exactly on the intervals so far, and beyond [a] the last one is open. *)
Definition correct a st acc : Prop :=
  (forall K, dom K -> ~~ above a K -> holds cs K = cover acc st K) /\
  (forall K, above a K -> has (fun f => f K) acc = false /\ onst st K = on st).

Lemma step a (b : Q) st acc st' acc' : proper (low_pt a) (pt_of b) -> correct a st acc ->
  (forall K, ~~ above a K -> cover acc' st' K = cover acc st K) ->
  (forall K, above a K -> K < qr R b -> holds cs K = cover acc' st' K) ->
  holds cs (qr R b) = cover acc' st' (qr R b) ->
  (forall K, qr R b < K -> has (fun f => f K) acc' = false /\ onst st' K = on st') ->
  correct (Some b) st' acc'.
Proof.
move=> ab [upto beyond] before inside atb after; split=> // K dK.
rewrite /= -leNgt le_eqVlt => /predU1P[->//|Kb].
case aK: (above a K); first exact: inside.
by rewrite before ?aK // upto // aK.
Qed.

Lemma above_trans a (b : Q) K : proper (low_pt a) (pt_of b) -> qr R b < K -> above a K.
Proof.
move/proper_lt; case: a => [a|] //= /negbFE; exact: lt_trans.
Qed.

Lemma not_above a (b : Q) K : proper (low_pt a) (pt_of b) -> ~~ above a K -> K < qr R b.
Proof.
by move=> ab; apply: contraR; rewrite -leNgt le_eqVlt => /predU1P[<-|/(above_trans ab)//]; have /negbFE := proper_lt ab.
Qed.

Lemma has_cat1 acc f K : has (fun f => f K) (acc ++ [:: f]) = has (fun f => f K) acc || f K.
Proof. by rewrite has_cat /= orbF. Qed.

Lemma on_domainP (P : R -> Prop) : (forall K, dom K -> P K) -> on_domain lower upper P.
Proof.
rewrite /dom /on_domain; by case: lower upper => [lo|] [up|] H K => [h|h|h|]; apply: H; rewrite //= andbT.
Qed.

Variable S : R -> Prop.
Hypothesis S_holds : forall K, dom K -> S K <-> holds cs K.

Lemma check_pieces_ok fuel a st acc ps :
  check_pieces fuel cs a upper (on st) ps -> correct a st acc -> say S lower upper a st acc ps.
Proof.
elim: ps a st acc => [|p ps IH] a st acc /=.
  move=> H [upto beyond]; apply: on_domainP => K dK; rewrite S_holds // any_has.
  have -> : has (fun f => f K) (if st is Some lo then acc ++ [:: since lo] else acc) = cover acc st K.
    by case: (st) => [lo|]; rewrite /cover /= ?has_cat1 ?orbF.
  case aK: (above a K); last by rewrite upto ?aK.
  have [noacc onK] := beyond K aK; rewrite /cover noacc onK.
  have abK : between (low_pt a) (high_pt upper) K.
    by rewrite between_ends aK; case/andP: dK.
  by case: (on st) H => [/in_on_ok->|/out_on_ok->].
case: p => [b|F b|F b|F b||b].
- case/andP => /andP[ab H] rest C; apply: (IH _ _ _ rest); have [upto beyond] := C.
  have aKb K : above a K -> K < qr R b -> between (low_pt a) (high_pt (Some b)) K.
    by move=> aK Kb; rewrite between_ends aK.
  apply: (step ab C) => // [K aK Kb||K /(above_trans ab)/beyond //].
    have [noacc onK] := beyond K aK; rewrite /cover noacc onK.
    by case: (on st) H => /andP[]; [move/in_on_ok->; rewrite ?aKb | move/out_on_ok->; rewrite ?aKb].
  have [noacc onK] := beyond _ (negbFE (proper_lt ab)); rewrite /cover noacc onK.
  by case: (on st) H => /andP[_]; rewrite ?(in_at_ok R) ?(out_at_ok R) // => /negPf.
- case/andP => /andP[/andP[/andP[off ab]]].
  case: a ab => [a|//] ab /andP[iso edg] atb rest C; have [upto beyond] := C.
  have [x [only pos _ _]] := isolates_ok R iso; have [_ /andP[ax xb] _] := only.
  exists x; split=> //; apply: (IH (Some b) (Some (Some x)) acc rest); case: st off C upto beyond {rest} => // _ C upto beyond.
  apply: (step ab C) => [K /=|K aK Kb||K bK] /=.
  + by rewrite -leNgt /cover /= orbF => Ka; rewrite lt_gtF ?orbF // (le_lt_trans Ka).
  + have [noacc _] := beyond K aK; rewrite /= in aK; rewrite /cover noacc /= -pos ?aK //.
    by rewrite (edge_ok edg) // between_qr aK.
  + by rewrite /cover /= xb orbT -(in_at_ok R).
  + by have [noacc _] := beyond K (above_trans ab bK); rewrite noacc (lt_trans xb).
- case/andP => /andP[/andP[/andP[on_ ab]]].
  case: a ab => [a|//] ab /andP[iso edg] atb rest C; have [upto beyond] := C.
  have [x [only _ neg _]] := isolates_ok R iso; have [_ /andP[ax xb] _] := only.
  have IHr acc' := IH (Some b) None acc' rest.
  case: st on_ C upto beyond => // lo _ C upto beyond.
  exists x; split=> //; apply: IHr.
  have part K : from_to lo x K = since lo K && (K < x) by case: (lo).
  apply: (step ab C) => [K /=|K aK Kb||K bK] /=.
  + rewrite -leNgt /cover has_cat1 /= orbF part => Ka.
    by rewrite (le_lt_trans Ka ax) andbT.
  + have [noacc sinceK] := beyond K aK; rewrite /= in aK; rewrite /cover has_cat1 noacc part /= orbF.
    by rewrite [since _ _]sinceK /= -neg ?aK // (edge_ok edg) // between_qr aK.
  + have [noacc _] := beyond _ (negbFE (proper_lt ab)).
    rewrite /cover has_cat1 noacc part /= orbF [qr R b < x]lt_gtF // andbF.
    by apply/negbTE; rewrite -(out_at_ok R).
  + have [noacc _] := beyond K (above_trans ab bK).
    by rewrite has_cat1 noacc part [K < x]lt_gtF ?andbF // (lt_trans xb).
- case/andP => /andP[/andP[/andP[on_ ab]]].
  case: a ab => [a|//] ab /andP[iso edg] atb rest C; have [upto beyond] := C.
  have [x [only _ _ zero]] := isolates_ok R iso; have [_ /andP[ax xb] _] := only.
  have IHr acc' := IH (Some b) (Some (Some x)) acc' rest.
  case: st on_ C upto beyond => // lo _ C upto beyond.
  exists x; split=> //; apply: IHr.
  have part K : from_to lo x K = since lo K && (K < x) by case: (lo).
  apply: (step ab C) => [K /=|K aK Kb||K bK] /=.
  + rewrite -leNgt /cover has_cat1 /= part => Ka.
    by rewrite (le_lt_trans Ka ax) andbT [x < K]lt_gtF ?orbF // (le_lt_trans Ka).
  + have [noacc sinceK] := beyond K aK; rewrite /= in aK; rewrite /cover has_cat1 noacc part /=.
    by rewrite [since _ _]sinceK /= (edge_ok edg) ?between_qr ?aK //= zero ?aK // neq_lt.
  + by rewrite /cover /= xb orbT -(in_at_ok R).
  + have [noacc _] := beyond K (above_trans ab bK).
    by rewrite has_cat1 noacc part [K < x]lt_gtF ?andbF (lt_trans xb).
- case: a => [a|//] /andP[off rest] C; have [upto beyond] := C.
  apply: (IH (Some a) (Some (Some (qr R a))) acc rest); case: st off C upto beyond {rest} => // _ C upto beyond.
  split=> K; last by move=> aK; have [noacc _] := beyond K aK; split.
  by move=> dK aK; rewrite upto // /cover /=; move: aK => /= /negPf->.
- case/andP => /andP[/andP[/andP[on_ ab] H] atb] rest C; have [upto beyond] := C.
  have IHr acc' := IH (Some b) None acc' rest.
  case: st on_ C upto beyond => // lo _ C upto beyond.
  apply: IHr.
  have part K : from_to lo (qr R b) K = since lo K && (K < qr R b) by case: (lo).
  apply: (step ab C) => [K /=|K aK Kb||K bK] /=.
  + by move=> aK; rewrite /cover has_cat1 /= orbF part (not_above ab aK) andbT.
  + have [noacc sinceK] := beyond K aK; rewrite /= in aK; rewrite /cover has_cat1 noacc part /= orbF.
    rewrite [since _ _]sinceK Kb /=; apply: (in_on_ok H).
    by rewrite (between_ends a (Some b)) aK.
  + have [noacc _] := beyond _ (negbFE (proper_lt ab)).
    rewrite /cover has_cat1 noacc part /= orbF ltxx andbF.
    by apply/negbTE; rewrite -(out_at_ok R).
  + have [noacc _] := beyond K (above_trans ab bK).
    by rewrite has_cat1 noacc part [K < _]lt_gtF ?andbF.
Qed.

End Answer.

(** ** A polynomial in z *)

Section Poly.
Variable R : rcfType.

Theorem says_ok (cs : list poly) (ans : answer) fuel (S : R -> Prop) :
  check_pieces fuel cs (lower ans) (upper ans) (starts ans) (pieces ans) ->
  (forall K, dom (lower ans) (upper ans) K -> S K <-> holds cs K) ->
  says S (lower ans) (upper ans) ans.
Proof.
move=> H SK; apply: (check_pieces_ok SK (fuel := fuel)).
  by rewrite /on; case: (starts ans) H.
split=> K; last by case: (starts ans).
by case/andP => ->.
Qed.

(** The statement about equivalent properties. *)
Lemma say_ext (S S' : R -> Prop) (lo up : option Q) a st acc ps :
  (forall K, S K <-> S' K) -> say S lo up a st acc ps -> say S' lo up a st acc ps.
Proof.
move=> SS; elim: ps a st acc => [|p ps IH] a st acc.
  have E K T : (S K <-> T) -> (S' K <-> T) by have := SS K; tauto.
  by rewrite /= /on_domain; case: lo => [lo|]; case: up => [up|] H K; try move=> h; apply: E; auto.
case: p => [b|F b|F b|F b||b] /=.
- exact: IH.
- by case: a => // a [y [only H]]; exists y; split=> //; apply: IH.
- by case: a => // a; case: st => // lo' [y [only H]]; exists y; split=> //; apply: IH.
- by case: a => // a; case: st => // lo' [y [only H]]; exists y; split=> //; apply: IH.
- by case: a => // a; apply: IH.
- by case: st => // lo'; apply: IH.
Qed.

Lemma says_ext (S S' : R -> Prop) (lo up : option Q) ans :
  (forall K, S K <-> S' K) -> says S lo up ans -> says S' lo up ans.
Proof. exact: say_ext. Qed.

End Poly.
