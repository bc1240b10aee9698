(** PWM DC motor drive (Gürbüz and Akpınar 2002): for which T it is stable.

    With K_pwm = 110.
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
Definition K_pwm : expr := 110.
Definition T : expr := Par.

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
Definition upper_limit_factor : poly := [
  -428441701800082585323258; 900193406559880719671845875; -77959174405586121099054900000;
  2866758430021930111435453125000; 502063016590742144138493750000; -2234055513355342504775716054687500;
  26745675763766775271767265625000000; 363133041965089715861389160156250000;
  -5013560061035860435281372070312500000; -5920822598295512706565856933593750000;
  159229432780859937286376953125000000000; -550398563360880196094512939453125000000;
  866716692098855972290039062500000000000; -595917235859669744968414306640625000000]%Z.

Definition limits : answer := {|
  lower := Some 0; upper := None; starts := true;
  pieces := [
    Along 0.000496939745106; Down upper_limit_factor 0.000496939745107; Along 0.000496939745115;
    Along 0.000496941; Along 0.000513; Along 0.044; Along 0.3; Along 0.4; Along 0.6] |}%Q.

Lemma checked : check_matrix 8 (Disc 1) 6 (feedback 6 2 4 Model.A Model.B Model.K Model.C) limits = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

(** ** The theorem *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From Jurist Require Import Real Sound Answer Region Eigenvalues.
Local Open Scope ring_scope.

(** [only_root F a b x]: F(x) = 0, a < x < b, and F has no other root there. *)
Theorem stable_set (R : rcfType) :
  exists upper_limit : R, only_root upper_limit_factor 0.000496939745106 0.000496939745107 upper_limit /\
  forall T : R, 0 < T ->
    (forall z : R[i],
      eigenvalue (map_mx (real_complex R) (mx 6 6 Model.A T
        - mx 6 2 Model.B T *m mx 2 4 Model.K T *m mx 4 6 Model.C T)) z -> `|z| < 1)
    <-> T < upper_limit.
Proof. exact: (feedback_answer R checked). Qed.

Print Assumptions stable_set.
