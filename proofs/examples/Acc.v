(** ACC benchmark (Wie and Bernstein 1992): continuous time, order 7, algebraic limits.

    The loop of examples/acc-benchmark.toml. *)

From Coq Require Import ZArith QArith List.
From Jurist Require Import Compute Entries.
Import ListNotations.

Module Model.
Local Open Scope expr_scope.
Definition k : expr := Par.

(** The characteristic polynomial, lowest power first. *)
Definition coefficients : list expr := [
  62500/2187*k;
  125000/729*k;
  100000/243*k;
  40000/81*k;
  80/3*k + 7280/27;
  2*k + 782/9;
  40/3;
  1].
End Model.

Definition lower_limit_factor : poly := [
  -9111997632; 28709773789; -7962286032]%Z.

Definition upper_limit_factor : poly := [
  9111997632; -28709773789; 7962286032]%Z.

Definition limits : answer := {|
  lower := Some 0; upper := None; starts := false;
  pieces := [
    Along 0.001; Along 0.192; Along 0.345; Along 0.351684783595; Up lower_limit_factor 0.351684783596;
    Along 3.25403519099; Down upper_limit_factor 3.254035191; Along 5.928; Along 63.252] |}%Q.

Lemma checked : check_coefs 8 (Left 0) Model.coefficients limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

Theorem acc_benchmark (R : rcfType) :
  exists lower_limit : R, only_root lower_limit_factor 0.351684783595 0.351684783596 lower_limit /\
  exists upper_limit : R, only_root upper_limit_factor 3.25403519099 3.254035191 upper_limit /\
  forall k : R, 0 < k ->
    let p := poly_of Model.coefficients k in
    (p`_7 != 0 /\ forall z : R[i], root (map_poly (real_complex R) p) z -> complex.Re z < 0)
    <-> lower_limit < k < upper_limit.
Proof. exact: (poly_answer R checked). Qed.

Print Assumptions acc_benchmark.
