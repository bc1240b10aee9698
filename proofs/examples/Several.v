(** Several intervals with algebraic ends, and an unbounded one: z - (1 - (K^3 - 3 K + 1)/10).

    A loop of order 1 whose gain is a polynomial in the parameter. *)

From Coq Require Import ZArith QArith List.
From Jurist Require Import Compute Entries.
Import ListNotations.

Module Model.
Local Open Scope expr_scope.
Definition K : expr := Par.

(** The characteristic polynomial, lowest power first. *)
Definition coefficients : list expr := [
  -1 + (K^3 - 3*K + 1)/10;
  1].
End Model.

Definition first_factor : poly := [
  1; -3; 0; 1]%Z.

Definition second_factor : poly := [
  -1; 3; 0; -1]%Z.

Definition third_factor : poly := [
  1; -3; 0; 1]%Z.

Definition limits : answer := {|
  lower := Some (-3); upper := Some 3; starts := false;
  pieces := [
    Along (-1.87938524158); Up first_factor (-1.87938524157); Along 0.347296355333; Down second_factor
    0.347296355334; Along 1.53208888623; Up third_factor 1.53208888624] |}%Q.

Lemma checked : check_coefs 8 (Disc 1) Model.coefficients limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

Theorem several_intervals (R : rcfType) :
  exists first : R, only_root first_factor (-1.87938524158) (-1.87938524157) first /\
  exists second : R, only_root second_factor 0.347296355333 0.347296355334 second /\
  exists third : R, only_root third_factor 1.53208888623 1.53208888624 third /\
  forall K : R, qr R (-3) < K < qr R 3 ->
    let p := poly_of Model.coefficients K in
    (p`_1 != 0 /\ forall z : R[i], root (map_poly (real_complex R) p) z -> `|z| < 1)
    <-> first < K < second \/ third < K.
Proof. exact: (poly_answer R checked). Qed.

Print Assumptions several_intervals.
