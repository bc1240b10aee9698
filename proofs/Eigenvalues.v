(** What the entries of a model stand for, and the theorems a generated file ends with: for which
    values of the parameter all eigenvalues (or all roots) are in the region. *)

From Coq Require Import ZArith QArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mathcomp Require Import ring.
From Jurist Require Import Compute Entries Jury Real Sound Answer Region.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Model.
Variable R : rcfType.
Local Notation C := R[i].
Implicit Types (e : expr) (f g : frac) (x y : R).

(** ** The statement's side *)

(** The value of a formula, the parameter being [x]. *)
Fixpoint val e x : R :=
  match e with
  | Num q => qr R q
  | Par => x
  | Plus a b => val a x + val b x
  | Minus a b => val a x - val b x
  | Times a b => val a x * val b x
  | Over a b => val a x / val b x
  | Neg a => - val a x
  | Power a n => val a x ^+ n
  end.

(** A matrix of formulas, read at [x]. *)
Definition mx (r c : nat) (m : matrix) x : 'M[R]_(r, c) := \matrix_(i < r, j < c) val (entry m i j) x.

(** All eigenvalues, as complex numbers, are in the region. *)
Definition eigenvalues_in (r : region) n (M : 'M[R]_n) : Prop :=
  forall z : C, eigenvalue (map_mx (real_complex R) M) z -> inside r z.

(** ** Fractions *)

Definition stands f x y : Prop := pev f.2 x != 0 /\ y * pev f.2 x = pev f.1 x.

Lemma pev1 x : pev [:: Zpos xH] x = 1.
Proof. by rewrite /= mulr0 addr0. Qed.

Lemma stands_norm f x y : stands f x y -> stands (fnorm f) x y.
Proof.
case: f => n d; rewrite /stands /fnorm -(pev_trim n) -(pev_trim d) => -[/=].
case En: (ptrim n) => [|a n'] d0 yE.
  rewrite pev1 oner_eq0 mulr1; split=> //; move/eqP: yE.
  by rewrite /= mulf_eq0 (negPf d0) orbF => /eqP.
rewrite -En in yE *; case: ifP => [/andP[/andP[_ /(pev_eq x) nE] /(pev_eq x) dE]|_]; last by [].
move: d0 yE; rewrite nE dE !pevZ mulf_eq0 negb_or => /andP[g0 d0] e; split=> //=.
by apply: (mulfI g0); rewrite mulrCA.
Qed.

Lemma common_ok a b x : pev a x != 0 -> pev b x != 0 ->
  let '(m, u, v) := common a b in
  [/\ pev m x != 0, pev m x = pev a x * pev u x & pev m x = pev b x * pev v x].
Proof.
move=> a0 b0; rewrite /common; case: ifP => [/(pev_eq x) e|_].
  by rewrite pev1 mulr1 -pevM.
case: ifP => [/(pev_eq x) e|_]; first by rewrite pev1 mulr1 -pevM.
case: ifP => [/andP[/(pev_eq x) e /(pev_eq x) bE]|_]; last first.
  by rewrite pevM mulf_neq0 // mulrC.
have u0 : pev (pquot b (Z.gcd (pcontent a) (pcontent b))) x != 0.
  by apply: contraNneq b0 => u0; rewrite bE pevZ u0 mulr0.
by split; [rewrite pevM mulf_neq0 | rewrite pevM | rewrite e pevM].
Qed.

Lemma stands_add f g x y z : stands f x y -> stands g x z -> stands (fadd f g) x (y + z).
Proof.
case: f g => [n d] [m c] [/= d0 yE] [/= c0 zE]; rewrite /fadd /=.
have := common_ok d0 c0; case: common => [[w u] v] [w0 wu wv]; apply: stands_norm; split=> //=.
by rewrite pevD !pevM mulrDl {1}wu wv !mulrA yE zE.
Qed.

Lemma stands_opp f x y : stands f x y -> stands (fopp f) x (- y).
Proof. by case=> d0 yE; split=> //=; rewrite pevN -yE mulNr. Qed.

Lemma stands_mul f g x y z : stands f x y -> stands g x z -> stands (fmul f g) x (y * z).
Proof.
case=> d0 yE [c0 zE]; apply: stands_norm; split; rewrite /= !pevM ?mulf_neq0 //.
by rewrite mulrACA yE zE.
Qed.

Lemma stands_div f g x y z : stands f x y -> stands g x z -> pev g.1 x != 0 -> stands (fdiv f g) x (y / z).
Proof.
case=> d0 yE [c0 zE] n0; apply: stands_norm; split; rewrite /= !pevM ?mulf_neq0 //.
have z0 : z != 0 by apply: contraNneq n0 => z0; rewrite -zE z0 mul0r.
by rewrite -yE -zE; field.
Qed.

Lemma stands_pow f n x y : stands f x y -> stands (fpow f n) x (y ^+ n).
Proof.
move=> H; elim: n => [|n IH]; first by rewrite /stands pev1 oner_eq0 mulr1 expr0.
by rewrite exprS; apply: stands_mul.
Qed.

Definition nonzero (gs : list poly) x : Prop := forall p : poly, List.In p gs -> pev p x != 0.

Lemma nonzero_cat (gs hs : list poly) x : nonzero (gs ++ hs)%list x -> nonzero gs x /\ nonzero hs x.
Proof. by move=> H; split=> g gi; apply: H; apply/in_or_app; [left|right]. Qed.

Lemma normal_ok e x : nonzero (guards e) x -> stands (normal e) x (val e x).
Proof.
elim: e => [q||a IHa b IHb|a IHa b IHb|a IHa b IHb|a IHa b IHb|a IHa|a IHa n] /=.
- move=> _; rewrite /stands /= !mulr0 !addr0 qrE gt_eqF ?pr_gt0 //; split=> //.
  by rewrite divfK // gt_eqF ?pr_gt0.
- by rewrite /stands pev1 oner_eq0 mulr1 /= mulr0 addr0 mulr1 add0r.
- by case/nonzero_cat => /IHa A /IHb B; apply: stands_add.
- by case/nonzero_cat => /IHa A /IHb B; apply: stands_add => //; apply: stands_opp.
- by case/nonzero_cat => /IHa A /IHb B; apply: stands_mul.
- move=> H; have [|/IHa A /IHb B] := @nonzero_cat (guards a) (guards b) x.
    by move=> g gi; apply: H; right.
  by apply: stands_div => //; apply: H; left.
- by move=> /IHa; apply: stands_opp.
- by move=> /IHa; apply: stands_pow.
Qed.

(** ** Matrices *)

Lemma nth_map_seq (A : Type) (F : nat -> A) s n i d : (i < n)%N ->
  List.nth i (List.map F (List.seq s n)) d = F (s + i)%N.
Proof.
elim: n s i => // n IH s [|i] /=; first by rewrite addn0.
by rewrite ltnS => /IH->; rewrite addSnnS.
Qed.

Lemma entry_tabulate r c F i j : (i < r)%N -> (j < c)%N -> entry (tabulate r c F) i j = F i j.
Proof. by move=> ir jc; rewrite /entry /tabulate nth_map_seq // nth_map_seq. Qed.

Lemma val_zero e x : is_zero e -> val e x = 0.
Proof. by case: e => //= q /Z.eqb_eq; rewrite qrE => ->; rewrite /= mul0r. Qed.

Lemma val_add a b x : val (eadd a b) x = val a x + val b x.
Proof.
rewrite /eadd; case: ifP => [/val_zero->|_]; first by rewrite add0r.
by case: ifP => // /val_zero->; rewrite addr0.
Qed.

Lemma val_sub a b x : val (esub a b) x = val a x - val b x.
Proof. by rewrite /esub; case: ifP => // /val_zero->; rewrite subr0. Qed.

Lemma val_mul a b x : val (emul a b) x = val a x * val b x.
Proof.
rewrite /emul; case: ifP => // /orP[] /val_zero->; by rewrite ?mul0r ?mulr0 /=.
Qed.

Lemma val_sum (F G : nat -> expr) s k x :
  val (List.fold_right (fun l e => eadd (emul (F l) (G l)) e) (Num 0) (List.seq s k)) x
  = \sum_(l < k) val (F (s + l)%N) x * val (G (s + l)%N) x.
Proof.
elim: k s => [|k IH] s; first by rewrite big_ord0.
rewrite [List.seq _ _]/= [List.fold_right _ _ _]/= val_add val_mul IH big_ord_recl addn0.
by congr (_ + _); apply: eq_bigr => l _; rewrite addSnnS.
Qed.

Lemma mprod_ok r k c (a b : matrix) x : mx r c (mprod r k c a b) x = mx r k a x *m mx k c b x.
Proof.
apply/matrixP => i j; rewrite !mxE entry_tabulate // (val_sum (entry a i) (fun l => entry b l j)).
by apply: eq_bigr => l _; rewrite !mxE.
Qed.

Lemma msub_ok r c (a b : matrix) x : mx r c (msub r c a b) x = mx r c a x - mx r c b x.
Proof. by apply/matrixP => i j; rewrite !mxE entry_tabulate // val_sub. Qed.

Lemma feedback_ok n m q (A B K C' : matrix) x :
  mx n n (feedback n m q A B K C') x = mx n n A x - mx n m B x *m mx m q K x *m mx q n C' x.
Proof. by rewrite /feedback msub_ok !mprod_ok. Qed.

(** ** The determinant, by its first row *)

Lemma nth_drop (A : Type) j k (l : list A) d : List.nth k (drop_nth j l) d = List.nth (bump j k) l d.
Proof.
have nth_none i : List.nth i (@nil A) d = d by case: i.
elim: l j k => [|a l IH] j k; first by case: j => [|j]; rewrite [drop_nth _ _]/= !nth_none.
case: j k => [|j] [|k] //=.
by rewrite IH bumpS.
Qed.

Lemma alternate_ok (F : nat -> bipoly) s n x :
  bpev (alternate (List.map F (List.seq s n))) x
  = \sum_(j < n) (-1) ^+ j * bpev (F (s + j)%N) x :> {poly R}.
Proof.
elim: n s => [|n IH] s; first by rewrite big_ord0.
rewrite /= bpevD bpevN IH big_ord_recl expr0 mul1r addn0; congr (_ + _).
by rewrite -sumrN; apply: eq_bigr => j _; rewrite exprS mulN1r mulNr addSnnS.
Qed.

Definition table n (rows : list (list bipoly)) x : 'M[{poly R}]_n :=
  \matrix_(i < n, j < n) bpev (List.nth j (List.nth i rows nil) nil) x.

Lemma det_ok n (rows : list (list bipoly)) x : bpev (det n rows) x = \det (table n rows x).
Proof.
elim: n rows => [|n IH] rows.
  by rewrite det_mx00 /= mulr0 addr0 mulr0 addr0.
pose F j := let y := List.nth j (List.hd nil rows) nil in
  if bzero y then nil else bmul y (det n (List.map (drop_nth j) (tl rows))).
have -> : det n.+1 rows = alternate (List.map F (List.seq 0 n.+1)) by [].
rewrite (expand_det_row _ ord0) alternate_ok; apply: eq_bigr => j _.
have -> : bpev (F (0 + j)%N) x = bpev (List.nth j (List.nth 0 rows nil) nil) x
    * bpev (det n (List.map (drop_nth j) (tl rows))) x.
  by rewrite add0n /F hd_nth; case: ifP => [/(bpev_zero x)->|_]; rewrite ?mul0r ?bpevM.
rewrite !mxE /cofactor /= add0n mulrCA; congr (_ * (_ * _)).
rewrite IH; congr (\det _); apply/matrixP => i k; rewrite !mxE; congr (bpev _ _).
have -> : List.nth i (List.map (drop_nth j) (tl rows)) nil = drop_nth j (List.nth i (tl rows) nil).
  have := List.map_nth (drop_nth j) (tl rows) nil i.
  by have -> : drop_nth j (nil : list bipoly) = nil by case: (nat_of_ord j).
by rewrite nth_drop nth_tl.
Qed.

(** ** The characteristic polynomial *)

Lemma char_row_check (r : list frac) f x : char_row_ok r -> List.In f r ->
  pev (row_den r) x = pev f.2 x * pev (pdiv (row_den r) f.2) x.
Proof. by move=> H fi; have /(pev_eq x)-> := proj1 (forallb_forall _ _) H f fi; rewrite pevM. Qed.

Lemma nth_In_seq (A : Type) (F : nat -> A) n i : (i < n)%N -> List.In (F i) (List.map F (List.seq 0 n)).
Proof. by move=> ilt; apply: in_map; apply/in_seq; split; [apply/ssrnat.leP | apply/ssrnat.ltP]. Qed.

Section Char.
Variables (n : nat) (A : matrix) (x : R).
Hypothesis guards_ok : nonzero (matrix_guards n A) x.
Hypothesis rows_ok : forallb char_row_ok (fractions n A).

Let frow i := List.nth i (fractions n A) nil.
Let den (i : 'I_n) : R := pev (row_den (frow i)) x.

Let frowE i : (i < n)%N -> frow i = List.map (fun j => normal (entry A i j)) (List.seq 0 n).
Proof. by move=> ilt; rewrite /frow nth_map_seq. Qed.

Let frow_in i : (i < n)%N -> List.In (frow i) (fractions n A).
Proof.
move=> ilt; rewrite frowE //.
exact: (@nth_In_seq _ (fun i => List.map (fun j => normal (entry A i j)) (List.seq 0 n))).
Qed.

Let den_nonzero i : den i != 0.
Proof.
apply: guards_ok; apply/in_or_app; right; apply: in_map; exact: frow_in.
Qed.

Let entry_ok i j : (i < n)%N -> (j < n)%N -> stands (normal (entry A i j)) x (val (entry A i j) x).
Proof.
move=> ilt jlt; apply: normal_ok => g gi; apply: guards_ok; apply/in_or_app; left.
apply/in_flat_map; exists i; split; first by apply/in_seq; split; [apply/ssrnat.leP | apply/ssrnat.ltP].
by apply/in_flat_map; exists j; split=> //; apply/in_seq; split; [apply/ssrnat.leP | apply/ssrnat.ltP].
Qed.

Lemma charpoly_ok : bpev (charpoly n A) x = (\prod_i den i) *: char_poly (mx n n A x).
Proof.
rewrite /charpoly det_ok -mul_polyC rmorph_prod /char_poly.
have -> : \prod_i (den i)%:P = \det (diag_mx (\row_i (den i)%:P)).
  by rewrite det_diag; apply: eq_bigr => i _; rewrite mxE.
rewrite -det_mulmx; congr (\det _); rewrite mul_diag_mx; apply/matrixP => i j.
rewrite !mxE (nth_map_seq _ _ _ (ltn_ord i)) add0n /char_row (nth_map_seq _ _ _ (ltn_ord j)) add0n.
rewrite -/(frow i) frowE // nth_map_seq // add0n -frowE //.
set f := normal _; have [f0 fE] := entry_ok (ltn_ord i) (ltn_ord j); rewrite -/f in f0 fE.
have fi : List.In f (frow i).
  by rewrite frowE //; apply: (@nth_In_seq _ (fun j => normal (entry A i j))).
have row_ok : char_row_ok (frow i) by apply: (proj1 (forallb_forall _ _) rows_ok); apply: frow_in.
have dE := char_row_check x row_ok fi.
have nE : pev (popp (pmul f.1 (pdiv (row_den (frow i)) f.2))) x = - (den i * val (entry A i j) x).
  by rewrite pevN pevM -fE /den dE; ring.
rewrite /char_entry; have -> : PeanoNat.Nat.eqb i j = (i == j) by apply/PeanoNat.Nat.eqb_spec/eqP => [/val_inj|->].
case: eqP => _ /=; rewrite nE ?mulr1n ?mulr0n polyCN polyCM -/(den i); ring.
Qed.

Lemma prod_den : \prod_i den i != 0.
Proof. by apply/prodf_neq0 => i _; apply: den_nonzero. Qed.

Lemma eigenvalues_charpoly r : length (charpoly n A) = n.+1 ->
  eigenvalues_in r (mx n n A x) <-> all_in r n (bpev (charpoly n A) x).
Proof.
move=> ln; rewrite charpoly_ok /all_in; have c0 := prod_den.
have rootE z : root (map_poly (real_complex R) ((\prod_i den i) *: char_poly (mx n n A x))) z
    = eigenvalue (map_mx (real_complex R) (mx n n A x)) z.
  by rewrite map_polyZ rootZ ?C0 // eigenvalue_root_char map_char_poly.
split=> [H|[_ H]]; last by move=> z; rewrite -rootE => /H.
split; last by move=> z; rewrite rootE => /H.
by rewrite coefZ mulf_neq0 // -[n in _`_n]/(n.+1.-1) -(size_char_poly (mx n n A x)) -lead_coefE (monicP (char_poly_monic _)) oner_neq0.
Qed.
End Char.

Lemma pval_eq0 q (p : poly) : Z.eqb 0 (pval q p) = (pev p (qr R q) == 0).
Proof.
have [w0 e] := phom_ok R q p; rewrite (zr_eq0 R).
by rewrite -(mulIr_eq0 _ (mulIf (lt0r_neq0 (pr_gt0 R (Qden q))))) e mulf_eq0 (gt_eqF w0) orbF.
Qed.

Lemma nonzero_over_ok fuel a b (p : poly) x :
  nonzero_over fuel a b p -> above a x && below b x -> pev p x != 0.
Proof.
rewrite /nonzero_over -[pev p x]pev_trim => H ab.
have line : nonzero_on fuel (low_pt a) (high_pt b) p -> pev (ptrim p) x != 0.
  by rewrite pev_trim => h; apply: (nonzero_on_ok h); rewrite between_ends.
have halves : a = None -> b = None -> nonzero_on fuel (low_pt None) (pt_of 0) p
    && ~~ Z.eqb 0 (pval 0 p) && nonzero_on fuel (pt_of 0) (high_pt None) p -> pev (ptrim p) x != 0.
  rewrite pev_trim => _ _ /andP[/andP[neg zero] pos]; case: (ltgtP x (qr R 0)) => x0.
  - by apply: (nonzero_on_ok neg); rewrite (between_ends None (Some (Qmake Z0 xH))) /= x0.
  - by apply: (nonzero_on_ok pos); rewrite (between_ends (Some (Qmake Z0 xH)) None) /= x0.
  - by rewrite x0 -pval_eq0.
have rest : (match a, b with
    | None, None => nonzero_on fuel (low_pt None) (pt_of 0) p
        && ~~ Z.eqb 0 (pval 0 p) && nonzero_on fuel (pt_of 0) (high_pt None) p
    | _, _ => nonzero_on fuel (low_pt a) (high_pt b) p end) -> pev (ptrim p) x != 0.
  by case: (a) (b) line halves => [a'|] [b'|] l h; [exact: l | exact: l | exact: l | exact: h].
case: (ptrim p) H rest => [|c [|d q]] H rest; [exact: rest | | exact: rest].
by rewrite /= mulr0 addr0 -(zr_eq0 R).
Qed.

Lemma all_nonzero_ok fuel ans (gs : list poly) x :
  all_nonzero fuel ans gs -> dom (lower ans) (upper ans) x -> nonzero gs x.
Proof.
move=> H dx p pi; exact: (nonzero_over_ok (proj1 (forallb_forall _ _) H p pi) dx).
Qed.

(** ** What a generated file uses *)

Theorem matrix_answer fuel r n (A : matrix) ans : check_matrix fuel r n A ans ->
  says (fun x => eigenvalues_in r (mx n n A x)) (lower ans) (upper ans) ans.
Proof.
case/andP => /andP[/andP[gs rows] /PeanoNat.Nat.eqb_spec ln].
case/(check_poly_conditions R) => cs [k [lk pieces_ok conds]].
have kn : n = k.+1 by move: lk; rewrite ln => -[].
apply: (says_ok pieces_ok) => x dx.
have E := eigenvalues_charpoly (all_nonzero_ok gs dx) rows r ln.
by have Cx := conds x; rewrite -kn in Cx; split=> [/E/Cx|/Cx/E].
Qed.

Theorem feedback_answer fuel r n m q (A B K C' : matrix) ans :
  check_matrix fuel r n (feedback n m q A B K C') ans ->
  says (fun x => eigenvalues_in r (mx n n A x - mx n m B x *m mx m q K x *m mx q n C' x))
    (lower ans) (upper ans) ans.
Proof.
move/matrix_answer; apply: says_ext => x; by rewrite feedback_ok.
Qed.

(** A polynomial given by its coefficients, lowest power first. *)
Definition poly_of (l : list expr) x : {poly R} := Poly [seq val e x | e <- l].

Lemma all_in_cleared r n (l : list expr) x : char_row_ok (coefs l) ->
  nonzero (flat_map guards l ++ [:: row_den (coefs l)])%list x ->
  all_in r n (bpev (cleared (coefs l)) x) <-> all_in r n (poly_of l x).
Proof.
move=> ok nz.
have d0 : pev (row_den (coefs l)) x != 0 by apply: nz; apply/in_or_app; right; left.
have -> : bpev (cleared (coefs l)) x = pev (row_den (coefs l)) x *: poly_of l x; last first.
  have cC : (pev (row_den (coefs l)) x)%:C%C != 0 :> C by rewrite C0.
  rewrite /all_in coefZ mulf_eq0 (negPf d0) /=.
  by split=> -[p0 H]; split=> // z; move: (H z); rewrite map_polyZ rootZ.
apply/polyP => i; rewrite coefZ coef_bpev coef_Poly /cleared.
have fs_ok f : List.In f (coefs l) -> pev (row_den (coefs l)) x = pev f.2 x * pev (pdiv (row_den (coefs l)) f.2) x.
  exact: char_row_check ok.
have e_ok e : List.In e l -> stands (normal e) x (val e x).
  move=> el; apply: normal_ok => p pi; apply: nz; apply/in_or_app; left.
  by apply/in_flat_map; exists e.
move: (row_den _) fs_ok {ok nz d0} => d; rewrite /coefs.
elim: l i e_ok => [|e l IH] [|i] e_ok fs_ok /=; rewrite ?mulr0 //; last first.
  by apply: IH => [f fi|f fi]; [apply: e_ok | apply: fs_ok]; right.
have [f0 fE] := e_ok e (or_introl erefl).
by rewrite pevM (fs_ok _ (or_introl erefl)) -fE; ring.
Qed.

Theorem poly_answer fuel r (l : list expr) ans : check_coefs fuel r l ans ->
  says (fun x => all_in r (size l).-1 (poly_of l x)) (lower ans) (upper ans) ans.
Proof.
case/andP => /andP[gs ok] /(check_poly_conditions R)[cs [k [lk pieces_ok conds]]].
have lE : size l = k.+2 by rewrite -lk /cleared /coefs !map_length.
apply: (says_ok pieces_ok) => x dx; rewrite lE -conds.
by rewrite (all_in_cleared _ _ ok (all_nonzero_ok gs dx)).
Qed.

End Model.
