(** The theorems of the drive by name; their statements are at the end of the two files. *)

From Jurist.drive Require Amplitude Period.

Definition drive := Amplitude.stable_set.
Definition drive_period := Period.stable_set.

Print Assumptions drive.
Print Assumptions drive_period.
