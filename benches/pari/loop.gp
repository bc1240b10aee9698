\\ The family of benches/drivers/bench_loop.rs in PARI/GP: gp -q -f benches/pari/loop.gp < /dev/null
default(parisizemax, "4G");
\\ Closed loop of the drive with f filter sections in the current feedback.
closedloop(f) =
{
  my(n = 6 + f, M = matrix(n, n), c = if(f, n, 1));
  M[1,1] = 1 - T*1000/46; M[1,2] = -T*550/46; M[1,3] = K*T*10000/552; M[1,4] = K*T*500000/552;
  M[2,1] = T*550/93; M[2,2] = 1 - T*8/93;
  M[3,c] = -1; M[3,5] = 1; M[3,6] = 5;
  M[4,c] = -T/2; M[4,3] = T/2; M[4,4] = 1; M[4,5] = T/2; M[4,6] = 5*T/2;
  M[5,2] = -1;
  M[6,2] = -T/2; M[6,5] = T/2; M[6,6] = 1;
  for(i = 1, f, M[6+i, if(i == 1, 1, 5+i)] = 3/10; M[6+i, 6+i] = 7/10);
  M;
}
\\ A symmetric polynomial in z of degree 2m as one in x = z + 1/z.
inx(S, m) =
{
  my(v = 'x, u = 2, R = polcoef(S, m, 'z));
  for(j = 1, m, R += polcoef(S, m + j, 'z)*v; [u, v] = [v, 'x*v - u]);
  R;
}
pair(D, n) = my(R = sum(i = 0, n, polcoef(D, i, 'z)*'z^(n-i))); [inx(D + R, n/2), inx((D - R)\('z^2 - 1), n/2 - 1)];
constraint(D, n) = my(h = pair(D, n)); polresultant(h[1], h[2], 'x);
limits(D, n) = my(r = constraint(D, n)); polrootsreal(r/content(r));
\\ Medians of five batches in milliseconds.
time(f) =
{
  my(k = 1, t, v);
  while(1, t = getwalltime(); for(i = 1, k, f()); if(getwalltime() - t >= 100, break); k *= 2);
  v = vecsort(vector(5, j, t = getwalltime(); for(i = 1, k, f()); (getwalltime() - t)/k*1.));
  v[3];
}
{
  foreach([0, 2, 4, 6, 10, 14, 18, 26, 34], f,
    my(n = 6 + f, M = closedloop(f), p = charpoly(M, 'z), h = pair(p, n));
    printf("n=%2d  charpoly(K,T) %9.4f ms   K at T=1e-4 %9.4f ms   T at K=110 %9.4f ms", n,
      time(() -> charpoly(M, 'z)), time(() -> limits(subst(p, T, 1/10000), n)), time(() -> limits(subst(p, K, 110), n)));
    if(f <= 10, printf("   boundary in (K,T) %10.4f ms", time(() -> polresultant(h[1], h[2], 'x))));
    print());
}
