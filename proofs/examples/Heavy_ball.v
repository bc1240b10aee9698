(** Gradient descent with momentum (Polyak 1964): a closed loop given by its matrix.

    The loop of examples/heavy-ball.toml, with alpha = 0.1 and beta = 0.9; the parameter is L. *)

From Coq Require Import ZArith QArith List.
From Jurist Require Import Compute Entries.
Import ListNotations.

Module Model.
Local Open Scope expr_scope.
Definition alpha : expr := 0.1.
Definition beta : expr := 0.9.
Definition L : expr := Par.

Definition A : matrix := [
  [1 + beta - alpha*L; -beta];
  [1; 0]].
End Model.

Definition limits : answer := {|
  lower := Some 0; upper := None; starts := true;
  pieces := [Until 38] |}%Q.

Lemma checked : check_matrix 8 (Disc 1) 2 Model.A limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

Theorem heavy_ball (R : rcfType) :
  forall L : R, 0 < L ->
    (forall z : R[i], eigenvalue (map_mx (real_complex R) (mx 2 2 Model.A L)) z -> `|z| < 1)
    <-> L < qr R 38.
Proof. exact: (matrix_answer R checked). Qed.

Print Assumptions heavy_ball.
