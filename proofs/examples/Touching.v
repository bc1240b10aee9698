(** Stable on both sides of an algebraic value, not at it: s + (K^2 - 2)^2.

    A loop of order 1. *)

From Coq Require Import ZArith QArith List.
From Jurist Require Import Compute Entries.
Import ListNotations.

Module Model.
Local Open Scope expr_scope.
Definition K : expr := Par.

(** The characteristic polynomial, lowest power first. *)
Definition coefficients : list expr := [
  (K^2 - 2)^2;
  1].
End Model.

Definition minus_root_two_factor : poly := [
  2; 0; -1]%Z.

Definition root_two_factor : poly := [
  -2; 0; 1]%Z.

Definition limits : answer := {|
  lower := None; upper := None; starts := true;
  pieces := [
    Along (-1.41421356238); Touch minus_root_two_factor (-1.41421356237); Along 1.41421356237; Touch
    root_two_factor 1.41421356238] |}%Q.

Lemma checked : check_coefs 8 (Left 0) Model.coefficients limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

Theorem touching (R : rcfType) :
  exists minus_root_two : R, only_root minus_root_two_factor (-1.41421356238) (-1.41421356237) minus_root_two /\
  exists root_two : R, only_root root_two_factor 1.41421356237 1.41421356238 root_two /\
  forall K : R,
    let p := poly_of Model.coefficients K in
    (p`_1 != 0 /\ forall z : R[i], root (map_poly (real_complex R) p) z -> complex.Re z < 0)
    <-> K < minus_root_two \/ minus_root_two < K < root_two \/ root_two < K.
Proof. exact: (poly_answer R checked). Qed.

Print Assumptions touching.
