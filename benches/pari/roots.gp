\\ PARI/GP's polrootsreal on the families of benches/drivers/bench_roots.rs. gp -q -f benches/pari/roots.gp < /dev/null
default(parisize, 4000000000);
median(v)=vecsort(v)[(#v + 2) \ 2];
bench(name,P)={my(times=List(),start=getwalltime(),t,r,k);
  \\ The clock ticks in milliseconds: fast families are timed in batches.
  r=polrootsreal(P); k=max(1,20\max(1,getwalltime()-start));
  while(getwalltime()-start<1000&&#times<500,t=getwalltime();for(i=1,k,r=polrootsreal(P));listput(times,(getwalltime()-t)*1./k));
  if(#times==0,listput(times,getwalltime()-start));
  printf("%-20s degree %4d  roots %4d  %10.3f ms\n",name,poldegree(P),#r,median(Vec(times)))};
{
bench("chebyshev 50",polchebyshev(50)); bench("chebyshev 200",polchebyshev(200)); bench("chebyshev 400",polchebyshev(400));
bench("wilkinson 50",prod(i=1,50,x-i)); bench("wilkinson 200",prod(i=1,200,x-i)); bench("wilkinson 200 + 1",prod(i=1,200,x-i)+1);
bench("laguerre 100",pollaguerre(100)*100!); bench("laguerre 300",pollaguerre(300)*300!);
bench("hermite 200",polhermite(200)); bench("legendre 100",pollegendre(100)*2^100);
bench("mignotte 50",x^50-2*(2^20*x-1)^2); bench("mignotte 200",x^200-2*(2^20*x-1)^2);
bench("mignotte' 40",x^40-2*(1000003*x-1)^2); bench("mignotte' 60",x^60-2*(1000003*x-1)^2);
names=["random 100 bit 100","random 100 bit 500","random 1000 bit 200"];
lines=readstr("benches/data/random.txt");
for(i=1,3,bench(names[i],Polrev(eval(Str("[",strjoin(strsplit(lines[i]," "),","),"]")))));
bench("exp series 200",sum(i=0,200,x^i*200!/i!));
}
