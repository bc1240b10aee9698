(** The computing part: exact integers only, the standard library only, run by [vm_compute].

    Nothing here is believed: Sound.v, Model.v and Answer.v prove what a result [true] means. A
    polynomial in the parameter is the list of its integer coefficients, lowest power first; a
    polynomial in z (or s) is the list of its coefficients, which are polynomials in the parameter. *)

From Coq Require Import ZArith List Bool QArith.
Import ListNotations.
Local Open Scope Z_scope.

Definition poly := list Z.
Definition bipoly := list poly.

(** ** Polynomials in the parameter *)

Fixpoint padd (p q : poly) : poly :=
  match p, q with
  | [], _ => q
  | _, [] => p
  | a :: p', b :: q' => a + b :: padd p' q'
  end.

Definition pscale (c : Z) (p : poly) : poly := map (Z.mul c) p.
Definition popp (p : poly) : poly := map Z.opp p.
Definition psub (p q : poly) : poly := padd p (popp q).

Fixpoint ptrim (p : poly) : poly :=
  match p with
  | [] => []
  | a :: p' => match ptrim p' with [] => if a =? 0 then [] else [a] | r => a :: r end
  end.

Fixpoint pmul (p q : poly) : poly :=
  match p with
  | [] => []
  | a :: p' => if a =? 0 then 0 :: pmul p' q else padd (pscale a q) (0 :: pmul p' q)
  end.

Definition pzero (p : poly) : bool := forallb (Z.eqb 0) p.
Definition peqb (p q : poly) : bool := pzero (psub p q).

Fixpoint pderiv_from (k : Z) (p : poly) : poly :=
  match p with [] => [] | a :: p' => k * a :: pderiv_from (k + 1) p' end.
Definition pderiv (p : poly) : poly := pderiv_from 1 (tl p).

(** Exact division; who uses the quotient multiplies it out again. *)
Fixpoint sub_prefix (c : Z) (p q : poly) : poly :=
  match p, q with a :: p', b :: q' => a - c * b :: sub_prefix c p' q' | _, _ => p end.
Fixpoint div_down (n : nat) (p q : poly) : poly :=
  match n, p, q with
  | S n', a :: p', b :: q' => let c := a / b in c :: div_down n' (sub_prefix c p' q') q
  | _, _, _ => []
  end.
Definition pdiv (p q : poly) : poly :=
  let p := ptrim p in
  let q := ptrim q in
  match q with
  | [1] => p
  | _ => rev (div_down (length p + 1 - length q) (rev p) (rev q))
  end.

Definition pcontent (p : poly) : Z := fold_right Z.gcd 0 p.
Definition pquot (p : poly) (c : Z) : poly := if c =? 1 then p else map (fun a => a / c) p.

(** The polynomial without its positive integer content, where the check succeeds. *)
Definition pprim (p : poly) : poly :=
  let c := pcontent p in
  let q := pquot p c in
  if (0 <? c) && peqb p (pscale c q) then q else p.

(** ** Polynomials in z *)

Fixpoint badd (p q : bipoly) : bipoly :=
  match p, q with
  | [], _ => q
  | _, [] => p
  | a :: p', b :: q' => padd a b :: badd p' q'
  end.

Definition bscale (c : poly) (p : bipoly) : bipoly := map (fun a => ptrim (pmul c a)) p.
Definition bopp (p : bipoly) : bipoly := map popp p.
Definition bzero (p : bipoly) : bool := forallb pzero p.

Fixpoint bmul (p q : bipoly) : bipoly :=
  match p with [] => [] | a :: p' => badd (bscale a q) ([] :: bmul p' q) end.

Definition bcontent (p : bipoly) : Z := fold_right (fun a c => Z.gcd (pcontent a) c) 0 p.

(** ** Jury's table

    A row loses the known factor [f] (the lead of the row two above) and its integer content; the
    quotients are multiplied out again, so nothing about the division has to be believed. *)

Fixpoint map2 {A B D : Type} (f : A -> B -> D) (l : list A) (m : list B) : list D :=
  match l, m with a :: l', b :: m' => f a b :: map2 f l' m' | _, _ => [] end.

Fixpoint all2 {A B : Type} (f : A -> B -> bool) (l : list A) (m : list B) : bool :=
  match l, m with a :: l', b :: m' => f a b && all2 f l' m' | [], [] => true | _, _ => false end.

Definition jrow (l : bipoly) : bipoly :=
  let h := hd [] l in
  let t := last l [] in
  map2 (fun x y => psub (pmul t x) (pmul h y)) (tl l) (tl (rev l)).

Definition divide_row (f : poly) (r : bipoly) : option bipoly :=
  let q := map (fun x => pdiv x f) r in
  let c := bcontent q in
  let q := map (fun x => pquot x c) q in
  if (0 <? c) && all2 (fun x y => peqb x (pscale c (pmul f y))) r q then Some q else None.

Fixpoint leads (n : nat) (f g : poly) (l : bipoly) : option (list poly) :=
  match n with
  | O => Some []
  | S n' =>
      match divide_row f (jrow l) with
      | None => None
      | Some q =>
          let lead := last q [] in
          match leads n' g (pprim lead) q with
          | None => None
          | Some rest => Some (lead :: rest)
          end
      end
  end.

Definition at_one (l : bipoly) : poly := fold_right padd [] l.
Definition at_minus_one (l : bipoly) : poly := fold_right psub [] l.

(** The conditions: polynomials in the parameter, all of them positive exactly where the
    polynomial keeps its degree and has all its roots inside the unit circle. *)
Definition conditions (l : bipoly) : option (list poly) :=
  match l with
  | _ :: _ :: rest =>
      let n := S (length rest) in
      let t := last l [] in
      match leads (length rest) [1] [1] l with
      | None => None
      | Some ls =>
          let m := at_minus_one l in
          Some (pmul t (at_one l) :: pmul t (if Nat.odd n then popp m else m) :: ls)
      end
  | _ => None
  end.

(** ** Signs on an interval

    A point is a pair: (a, c) for a / c, (1, 0) and (-1, 0) for the infinite ends. *)

Definition pt := (Z * Z)%type.
Definition pt_of (q : Q) : pt := (Qnum q, Zpos (Qden q)).

Definition plin (a b : Z) (p : poly) : poly := padd (pscale a p) (0 :: pscale b p).

(** The numerator of p ((a + b t) / (c + d t)) and the power of the denominator. *)
Fixpoint pmob (a b c d : Z) (p : poly) : poly * poly :=
  match p with
  | [] => ([], [1])
  | x :: p' => let (h, w) := pmob a b c d p' in (padd (pscale x w) (plin a b h), plin c d w)
  end.

(** The same in steps for finite a: y = D K, a shift by an integer, and for a finite b the scale of
    the interval, the reversed coefficients and a shift by 1: additions instead of long products. *)
Fixpoint over_den (D : Z) (p : poly) : poly * Z :=
  match p with [] => ([], 1) | x :: p' => let (q, w) := over_den D p' in (x * w :: q, D * w) end.
Fixpoint shift (a : Z) (p : poly) : poly :=
  match p with [] => [] | x :: p' => padd [x] (plin a 1 (shift a p')) end.
Fixpoint stretch (w m : Z) (p : poly) : poly :=
  match p with [] => [] | x :: p' => m * x :: stretch w (w * m) p' end.

(** The polynomial on the interval from a to b, up to a positive factor, as one on the ray t > 0. *)
Definition mob (a b : pt) (p : poly) : poly :=
  let p := ptrim p in
  let (x, c) := a in
  let (y, d) := b in
  if (0 <? c) && (d =? 0) then shift x (fst (over_den c p))
  else
    let D := Z.lcm c d in
    let u := x * (D / c) in
    let v := y * (D / d) in
    if (0 <? c) && (0 <? d) && (0 <? D) && (u * c =? x * D) && (v * d =? y * D) then
      shift 1 (rev (stretch (v - u) 1 (shift u (fst (over_den D p)))))
    else fst (pmob x y c d p).

Fixpoint phom (a c : Z) (p : poly) : Z * Z :=
  match p with [] => (0, 1) | x :: p' => let (v, w) := phom a c p' in (x * w + a * v, c * w) end.
(** A number with the sign of p at the finite point q. *)
Definition pval (q : Q) (p : poly) : Z := fst (phom (Qnum q) (Zpos (Qden q)) p).

(** Positive for every t > 0: no coefficient is negative, or so in both halves of a subdivision.
    ([if] and not [||], whose two sides [vm_compute] would both run.) *)
Fixpoint ray_pos (fuel : nat) (q : poly) : bool :=
  let q := ptrim q in
  match q with
  | [] => false
  | a :: _ =>
      if (0 <=? a) && (0 <? last q 0) then
        if forallb (Z.leb 0) q then true
        else match fuel with
             | O => false
             | S f =>
                 if 0 <? fold_right Z.add 0 q then
                   if ray_pos f (fst (pmob 0 1 1 1 q)) then ray_pos f (fst (pmob 1 1 1 0 q)) else false
                 else false
             end
      else false
  end.

Definition proper (a b : pt) : bool :=
  (0 <=? snd a) && (0 <=? snd b) && (0 <? fst b * snd a - fst a * snd b).

Definition pos_on (fuel : nat) (a b : pt) (p : poly) : bool := proper a b && ray_pos fuel (mob a b p).
Definition nonzero_on (fuel : nat) (a b : pt) (p : poly) : bool :=
  if pos_on fuel a b p then true else pos_on fuel a b (popp p).
Definition nonpos_on (a b : pt) (p : poly) : bool := proper a b && forallb (fun x => x <=? 0) (mob a b p).

(** ** Conditions on an interval *)

Fixpoint some {A : Type} (f : A -> bool) (l : list A) : bool :=
  match l with [] => false | a :: l' => if f a then true else some f l' end.

Definition in_on (fuel : nat) (cs : list poly) (a b : pt) : bool := forallb (pos_on fuel a b) cs.
Definition in_at (cs : list poly) (q : Q) : bool := forallb (fun p => 0 <? pval q p) cs.
Definition out_on (cs : list poly) (a b : pt) : bool := some (nonpos_on a b) cs.
Definition out_at (cs : list poly) (q : Q) : bool := some (fun p => pval q p <=? 0) cs.

(** p = F^m * g: how often F divides p, and what is left. *)
Fixpoint strip (fuel : nat) (F p : poly) : nat * poly :=
  match fuel with
  | O => (O, p)
  | S f =>
      let g := pdiv p F in
      if negb (pzero p) && peqb p (pmul F g) then let (m, h) := strip f F g in (S m, h) else (O, p)
  end.
Definition strip_all (F p : poly) : nat * poly := strip (length p) F p.

(** F is increasing from negative to positive: it has one root between a and b. *)
Definition isolates (fuel : nat) (F : poly) (a b : Q) : bool :=
  pos_on fuel (pt_of a) (pt_of b) (pderiv F) && (pval a F <? 0) && (0 <? pval b F).

Inductive side := Rising | Falling | Touching.

(** On (a, b) the conditions hold exactly where F > 0 (Rising), F < 0 (Falling), F <> 0 (Touching). *)
Definition edge (fuel : nat) (s : side) (cs : list poly) (F : poly) (a b : Q) : bool :=
  let parts := map (strip_all F) cs in
  let flip m := match s with Falling => Nat.odd m | _ => false end in
  forallb (fun mg : nat * poly =>
             let (m, g) := mg in pos_on fuel (pt_of a) (pt_of b) (if flip m then popp g else g)) parts &&
  match s with
  | Touching => forallb (fun mg => Nat.even (fst mg)) parts && existsb (fun mg => negb (Nat.eqb (fst mg) 0)) parts
  | _ => existsb (fun mg => Nat.odd (fst mg)) parts
  end.

(** ** The answer, piece by piece from the left

    Each piece leads from the end of the one before to its own end [b]:
    [Along b]: no change, up to b and at b;
    [Up F b]: the root of F between them is a lower limit of the stable set;
    [Down F b]: the root of F between them is an upper limit;
    [Touch F b]: stable on both sides of the root of F, not at it;
    [From]: a lower limit where we stand; [Until b]: an upper limit at b. *)
Inductive piece :=
  | Along (b : Q) | Up (F : poly) (b : Q) | Down (F : poly) (b : Q) | Touch (F : poly) (b : Q)
  | From | Until (b : Q).

Definition low_pt (a : option Q) : pt := match a with Some q => pt_of q | None => (-1, 0) end.
Definition high_pt (a : option Q) : pt := match a with Some q => pt_of q | None => (1, 0) end.

Fixpoint check_pieces (fuel : nat) (cs : list poly) (a upper : option Q) (on : bool) (ps : list piece) : bool :=
  let to b := proper (low_pt a) (pt_of b) in
  let side s F b :=
    match a with None => false | Some a => isolates fuel F a b && edge fuel s cs F a b end in
  match ps with
  | [] => if on then in_on fuel cs (low_pt a) (high_pt upper) else out_on cs (low_pt a) (high_pt upper)
  | Along b :: ps' =>
      to b && (if on then in_on fuel cs (low_pt a) (pt_of b) && in_at cs b
               else out_on cs (low_pt a) (pt_of b) && out_at cs b)
      && check_pieces fuel cs (Some b) upper on ps'
  | Up F b :: ps' =>
      negb on && to b && side Rising F b && in_at cs b && check_pieces fuel cs (Some b) upper true ps'
  | Down F b :: ps' =>
      on && to b && side Falling F b && out_at cs b && check_pieces fuel cs (Some b) upper false ps'
  | Touch F b :: ps' =>
      on && to b && side Touching F b && in_at cs b && check_pieces fuel cs (Some b) upper true ps'
  | From :: ps' =>
      match a with None => false | Some _ => negb on && check_pieces fuel cs a upper true ps' end
  | Until b :: ps' =>
      on && to b && in_on fuel cs (low_pt a) (pt_of b) && out_at cs b
      && check_pieces fuel cs (Some b) upper false ps'
  end.

(** The region of the roots: inside the circle of radius r, or left of the line at -s. *)
Inductive region := Disc (r : Q) | Left (s : Q).

(** The polynomial in z with its roots in the unit circle where those of [p] are in the region. *)
Definition blin (a b : Z) (p : bipoly) : bipoly := badd (map (pscale a) p) ([] :: map (pscale b) p).
Fixpoint bmob (a b c d : Z) (p : bipoly) : bipoly * poly :=
  match p with
  | [] => ([], [1])
  | x :: p' =>
      let (h, w) := bmob a b c d p' in (badd (map (fun k => pscale k x) w) (blin a b h), plin c d w)
  end.
Definition to_disc (r : region) (p : bipoly) : bipoly :=
  match r with
  | Disc q => fst (bmob 0 (Qnum q) (Zpos (Qden q)) 0 p)
  | Left s =>
      let u := Qnum s in
      let v := Zpos (Qden s) in
      fst (bmob (- (v + u)) (v - u) v v p)
  end.
Definition region_ok (r : region) : bool :=
  match r with Disc q => 0 <? Qnum q | Left s => true end.

Definition bprim (p : bipoly) : bipoly :=
  let c := bcontent p in
  let q := map (fun x => pquot x c) p in
  if (0 <? c) && all2 (fun x y => peqb x (pscale c y)) p q then q else p.

(** ** A whole answer for a polynomial *)
Record answer := Answer { lower : option Q; upper : option Q; starts : bool; pieces : list piece }.

Definition check_poly (fuel : nat) (r : region) (p : bipoly) (ans : answer) : bool :=
  region_ok r &&
  match conditions (bprim (to_disc r p)) with
  | None => false
  | Some cs => check_pieces fuel cs (lower ans) (upper ans) (starts ans) (pieces ans)
  end.

(** ** One point

    Numbers instead of a parameter: constants, read at 0. The table ends with the first row that does not go
    on, so a row of zeros is an answer as well. *)
Fixpoint point_jury (n : nat) (l : bipoly) : bool :=
  match n with
  | O => negb (0 =? pval 0 (hd [] l))
  | S n' =>
      let r := bprim (jrow l) in
      if 0 <? pval 0 (last r []) then point_jury n' r else false
  end.

Definition point_in (r : region) (n : nat) (p : bipoly) : bool := point_jury n (bprim (to_disc r p)).
Definition point_nonzero (gs : list poly) : bool := forallb (fun g => negb (0 =? pval 0 g)) gs.
