(** Jury's test, textbook exercise (Ogata 1995): all |z| < 0.9.

    The loop of examples/ogata-jury.toml. *)

From Coq Require Import ZArith QArith List.
From Jurist Require Import Compute Entries.
Import ListNotations.

Module Model.
Local Open Scope expr_scope.
Definition K : expr := Par.

(** The characteristic polynomial, lowest power first. *)
Definition coefficients : list expr := [
  0.3679 + 0.2642*K;
  -1.3679 + 0.3679*K;
  1].
End Model.

Definition limits : answer := {|
  lower := None; upper := None; starts := false;
  pieces := [
    Along (5321#59531); From; Until (4421#2642)] |}%Q.

Lemma checked : check_coefs 8 (Disc 0.9) Model.coefficients limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

Theorem ogata_radius (R : rcfType) :
  forall K : R,
    let p := poly_of Model.coefficients K in
    (p`_2 != 0 /\ forall z : R[i], root (map_poly (real_complex R) p) z -> `|z| < (qr R 0.9)%:C%C)
    <-> qr R (5321#59531) < K < qr R (4421#2642).
Proof. exact: (poly_answer R checked). Qed.

Print Assumptions ogata_radius.
