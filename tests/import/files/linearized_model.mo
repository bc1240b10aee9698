model linearized_model "Servo.Drive"
  parameter Integer n = 3 "number of states";
  parameter Integer m = 1 "number of inputs";
  parameter Integer p = 1 "number of outputs";
  parameter Real x0[n] = {0, 0, 1.570796326794897};
  parameter Real u0[m] = {0};

  parameter Real A[n, n] =
	[-21.73913043478261, -11.95652173913043, 0;
	5.913978494623656, -0.08602150537634409, 0;
	0, 1, 0];

  parameter Real B[n, m] =
	[21.73913043478261;
	0;
	0];

  parameter Real C[p, n] =
	[0, 0, 1];

  parameter Real D[p, m] =
	[0];


  Real x[n](start=x0);
  input Real u[m](start=u0);
  output Real y[p];

  Real 'x_motor.i' = x[1];
  Real 'x_motor.w' = x[2];
  Real 'x_load.phi' = x[3];
  Real 'u_voltage' = u[1];
  Real 'y_angle' = y[1];
equation
  der(x) = A * x + B * u;
  y = C * x + D * u;
end linearized_model;
