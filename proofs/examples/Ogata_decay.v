(** Routh's test, textbook exercise (Ogata 2010): decay rate 0.1, rational limits.

    The loop of examples/ogata-hurwitz.toml. *)

From Coq Require Import ZArith QArith List.
From Jurist Require Import Compute Entries.
Import ListNotations.

Module Model.
Local Open Scope expr_scope.
Definition K : expr := Par.

(** The characteristic polynomial, lowest power first. *)
Definition coefficients : list expr := [
  K;
  2;
  3;
  3;
  1].
End Model.

Definition limits : answer := {|
  lower := None; upper := None; starts := false;
  pieces := [
    Along (-9); Along (-0.264); Along 0.1729; From; Until (114156#105625); Along 4.964] |}%Q.

Lemma checked : check_coefs 8 (Left 0.1) Model.coefficients limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

Theorem ogata_decay (R : rcfType) :
  forall K : R,
    let p := poly_of Model.coefficients K in
    (p`_4 != 0 /\ forall z : R[i], root (map_poly (real_complex R) p) z -> complex.Re z < - qr R 0.1)
    <-> qr R 0.1729 < K < qr R (114156#105625).
Proof. exact: (poly_answer R checked). Qed.

Print Assumptions ogata_decay.
