(** PWM DC motor drive (Gürbüz and Akpınar 2002): for which K_pwm it is stable.

    With T = 0.0001.
    The entries are those of the model, as typed; the statement is about the eigenvalues of A - B K C. *)

From Coq Require Import ZArith QArith List.
From Jurist Require Import Compute Entries.
Import ListNotations.

(** ** The model *)
Module Model.
Local Open Scope expr_scope.

Definition R_a : expr := 1.
Definition L_a : expr := 46e-3.
Definition J : expr := 0.093.
Definition B_v : expr := 0.008.
Definition K_a : expr := 0.55.
Definition E_sw : expr := 12.
Definition K_pi : expr := 10.
Definition K_ii : expr := 500.
Definition K_ps : expr := 1.
Definition K_is : expr := 5.
Definition k_1 : expr := 1.
Definition k_2 : expr := 1.
Definition K_pwm : expr := Par.
Definition T : expr := 0.0001.

Definition A : matrix := [
  [(L_a - R_a*T)/L_a; -K_a*T/L_a; 0; 0; 0; 0];
  [K_a*T/J; (J - B_v*T)/J; 0; 0; 0; 0];
  [-k_1; 0; 0; 0; 0; 0];
  [-k_1*T/2; 0; T/2; 1; 0; 0];
  [0; -k_2; 0; 0; 0; 0];
  [0; -k_2*T/2; 0; 0; T/2; 1]].

Definition B : matrix := [
  [0; K_pwm*T/(L_a*E_sw)];
  [0; 0];
  [1; 0];
  [T/2; 0];
  [0; 0];
  [0; 0]].

Definition K : matrix := [
  [0; 0; -K_ps; -K_is];
  [-K_pi; -K_ii; 0; 0]].

Definition C : matrix := [
  [0; 0; 1; 0; 0; 0];
  [0; 0; 0; 1; 0; 0];
  [0; 0; 0; 0; 1; 0];
  [0; 0; 0; 0; 0; 1]].
End Model.

(** ** The limits: polynomials with integer coefficients, lowest power first, and the way along the
    parameter's domain that is checked. *)
Definition lower_limit_factor : poly := [
  -3283537901868887941998182400000000000000000; 82410977252569897601397824579258286080000000;
  98953329107857441138421662755308778379264000; -179879217110589761114806525231282995234880;
  -114405713599184305228796989052391]%Z.

Definition upper_limit_factor : poly := [
  3283537901868887941998182400000000000000000; -82410977252569897601397824579258286080000000;
  -98953329107857441138421662755308778379264000; 179879217110589761114806525231282995234880;
  114405713599184305228796989052391]%Z.

Definition limits : answer := {|
  lower := Some 0; upper := None; starts := false;
  pieces := [
    Along 0.0381005333482; Up lower_limit_factor 0.0381005333483; Along 550.941166686674;
    Down upper_limit_factor 550.941166686675; Along 550.9411666866772; Along 550.941177; Along 554.2;
    Along 1000000000] |}%Q.

Lemma checked : check_matrix 8 (Disc 1) 6 (feedback 6 2 4 Model.A Model.B Model.K Model.C) limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

(** ** The theorem *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

(** [only_root F a b x]: F(x) = 0, a < x < b, and F has no other root there. *)
Theorem stable_set (R : rcfType) :
  exists lower_limit : R, only_root lower_limit_factor 0.0381005333482 0.0381005333483 lower_limit /\
  exists upper_limit : R, only_root upper_limit_factor 550.941166686674 550.941166686675 upper_limit /\
  forall K_pwm : R, 0 < K_pwm ->
    (forall z : R[i],
      eigenvalue (map_mx (real_complex R) (mx 6 6 Model.A K_pwm
        - mx 6 2 Model.B K_pwm *m mx 2 4 Model.K K_pwm *m mx 4 6 Model.C K_pwm)) z -> `|z| < 1)
    <-> lower_limit < K_pwm < upper_limit.
Proof. exact: (feedback_answer R checked). Qed.

Print Assumptions stable_set.
