(** Routh's test, an unstable plant (Franklin, Powell and Emami-Naeini): continuous time, a rational limit.

    The loop of examples/franklin-hurwitz.toml. *)

From Coq Require Import ZArith QArith List.
From Jurist Require Import Compute Entries.
Import ListNotations.

Module Model.
Local Open Scope expr_scope.
Definition K : expr := Par.

(** The characteristic polynomial, lowest power first. *)
Definition coefficients : list expr := [
  K;
  K - 6;
  5;
  1].
End Model.

Definition limits : answer := {|
  lower := None; upper := None; starts := false;
  pieces := [
    Along (-6); Along 0.75; Along 4.125; Along 7.5; From] |}%Q.

Lemma checked : check_coefs 8 (Left 0) Model.coefficients limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

Theorem franklin_hurwitz (R : rcfType) :
  forall K : R,
    let p := poly_of Model.coefficients K in
    (p`_3 != 0 /\ forall z : R[i], root (map_poly (real_complex R) p) z -> complex.Re z < 0)
    <-> qr R 7.5 < K.
Proof. exact: (poly_answer R checked). Qed.

Print Assumptions franklin_hurwitz.
