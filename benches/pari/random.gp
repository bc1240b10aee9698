\\ Writes the random polynomials of the comparison, from the constant term up: gp -q -f benches/pari/random.gp < /dev/null > benches/data/random.txt
setrand(7);
out(P)={my(v=Vecrev(P));for(i=1,#v,if(i>1,print1(" "));print1(v[i]));print()};
{
out(Pol(vector(101,i,random(2^101)-2^100)));
out(Pol(vector(501,i,random(2^101)-2^100)));
out(Pol(vector(201,i,random(2^1001)-2^1000)));
}
