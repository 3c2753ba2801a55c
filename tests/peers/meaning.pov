// Read by POV-Ray and by pscn, which print the same: control flow, macros, functions, arrays.
#version 3.7;
global_settings { assumed_gamma 1 }
#macro D(T, V) #debug concat(T, " ", str(V, 0, 10), "\n") #end
#macro DV(T, V) #debug concat(T, " ", vstr(3, V, ", ", 0, 6), "\n") #end

// random numbers
#declare S = seed(0); D("rand 0", rand(S)) D("rand 0", rand(S)) D("rand 0", rand(S)*1e10)
#declare S = seed(42); D("rand 42", rand(S)) D("rand 42", rand(S))
#declare S = seed(-7.6); D("rand -7.6", rand(S))
#declare S = seed(1e10); D("rand 1e10", rand(S))
#declare R = seed(5); #declare R2 = R; D("same stream", rand(R)) D("same stream", rand(R2)) D("same stream", rand(R))
#declare A = seed(3); #declare B = seed(3); D("two streams", rand(A)) D("two streams", rand(B))
DV("three", <rand(R), rand(R), rand(R)>)
#declare A = (1 ? rand(R) : rand(R)); D("both branches draw", A) D("both branches draw", rand(R))

// comparisons and logic
D("3>2>1", (3 > 2 > 1)) D("1|0&0", (1 | 0 & 0)) D("1<2&3<2", (1 < 2 & 3 < 2)) D("1+1<3", (1 + 1 < 3))
D("equal", (1 = 1 + 1e-11)) D("equal", (1 = 1 + 1e-9)) D("less", (1 < 1 + 1e-11)) D("at most", (1 <= 1 - 1e-11))
D("at least", (1 >= 1 + 1e-11)) D("at least", (2 >= 3)) D("unequal", (1 != 1 + 1e-11)) D("3>=2>=1", (3 >= 2 >= 1))
D("not", !5) D("not", !1e-11) D("not", !0 + 1) D("not", -!0) D("not", (!0 = 1 & !1 = 0)) D("not", !(1 < 2))
D("choice", (1 ? 2 : 0 ? 3 : 4)) D("choice", (1 < 0 ? 2 : 1 > 0 ? 3 : 4)) D("choice", (0 ? 1 : 0 ? 2 : 3))
D("sum", (1 = 1) + (2 > 1)*2) D("chain", (1 < 2 = 1)) D("minus", 2*-3) D("component", -x.x)
DV("parts", <(1 < 2), (3 > 2), 4>) DV("times", <1, 2, 3>*(1 < 2)) DV("plus", x + (y < 0)) DV("parts", (<1, 2, 3> < <1, 3, 4>))
DV("quotients", <1, 2, 3>/<2, 4, 6>) D("component", <1, 2, 3>.z)

// functions
D("mod", mod(-7, 3)) D("div", div(-7, 3)) D("int", int(-2.5)) D("floor", floor(-2.5)) D("ceil", ceil(2.1))
D("select", select(-1, 10, 20, 30)) D("select", select(0, 10, 20, 30)) D("select", select(1e-12, 10, 20, 30))
D("select", select(0, 10, 20)) D("select", select(-1, 10, 20)) D("min", min(3, 1, 2)) D("max", max(3, 1, 2))
D("abs", abs(-3)) D("acos", acos(0.5)) D("asin", asin(0.5)) D("atan2", atan2(1, -1)) D("cos", cos(1)) D("sin", sin(1))
D("tan", tan(1)) D("degrees", degrees(1)) D("radians", radians(180)) D("exp", exp(1)) D("ln", ln(10)) D("log", log(100))
D("pow", pow(2, 10)) D("pow", pow(2, 0.5)) D("sqrt", sqrt(2)) D("sinh", sinh(1)) D("cosh", cosh(1)) D("tanh", tanh(1))
D("asinh", asinh(1)) D("acosh", acosh(2)) D("atanh", atanh(0.5))
D("vlength", vlength(<3, 4, 0>)) D("vlength", vlength(3)) D("vdot", vdot(<1, 2, 3>, 2)) DV("vcross", vcross(x, <1, 2, 3>))
DV("vnormalize", vnormalize(<0, 3, 4>)) DV("vnormalize", vnormalize(3)) DV("vrotate", vrotate(<1, 2, 3>, <10, 20, 30>))
DV("vaxis_rotate", vaxis_rotate(<1, 2, 3>, <1, 1, 0>, 40)) DV("vaxis_rotate", vaxis_rotate(x, y, 90))
D("true", true) D("yes", yes) D("on", on) D("false", false) D("no", no) D("off", off) D("pi", pi)
D("strlen", strlen("hello")) D("defined", defined(A)) D("defined", defined(Nothing)) D("defined", defined(D))
#debug concat("str ", str(3.14159, 8, 3), "|", str(-2.5, 0, 0), "|", str(1e20, 0, -1), "|", str(5, -8, 2), "|\n")
#debug concat("str ", str(12345.678, 12, 2), "|", str(1/3, 0, -1), "|", chr(65), "|\t|\\|\"|\n")
#debug concat("vstr ", vstr(2, <1.5, 2, 3>, "; ", 6, 1), "\n")
#declare Text = concat("a", str(2, 0, 0)); #debug Text #debug "\n"

// loops
#for (I, 1, 3) D("for", I) #end D("after", I)
#for (I, 3, 1) D("never", I) #end D("after", I)
#for (I, 3, 1, -1) #declare I = I - 0.5; D("down", I) #end D("after", I)
#for (I, 2, 0, -1) D("down to 0", I) #end #for (I, 0, 1, 0.1) #end D("after", I)
#for (I, 0, 1 - 1e-11, 1) D("nearly", I) #end
#for (I, 0, 1 - 1e-9, 1) D("not quite", I) #end
#for (I, 1, 2) #for (J, 1, 2) D("nested", I*10 + J) #end #end
#declare I = 0;
#while (I < 10) #declare I = I + 1; #if (I = 3) #break #end D("while", I) #end D("broken off", I)
#for (K, 0, 9) #if (K = 2) #break #end #end D("broken off", K)
#while (1) #if (1) #switch (1) #case (1) #break #end #break #end #end
#while (0) #else #debug "never\n" #end
#local N = 0; #while (N < 3) #local N = N + 1; #end D("local", N)
#switch (3) #case (1) #debug "one\n" #break #range (2, 4) #debug "range\n" #case (9) #debug "on\n" #break #else #debug "else\n" #end
#switch (7) #case (1) #debug "one\n" #break #else #debug "else\n" #end
#switch (1 + 1e-11) #case (1) #debug "nearly one\n" #break #else #debug "else\n" #end
#switch (2) #case (1) #debug "1" #case (2) #debug "2" #case (3) #debug "3\n" #break #debug "never\n" #end
#switch (1) #debug "before " #case (1) #debug "one " #else #debug "and else\n" #end
#switch (5) #range (1, 3) #debug "never\n" #break #end
#if (0) #elseif (1) #debug "elseif\n" #else #debug "else\n" #end
#if (1) #debug "if\n" #else #debug "else\n" #end
#if (2) #debug "2\n" #end #if (1e-11) #debug "never\n" #else #debug "not 1e-11\n" #end
#ifndef (Once) #declare Once = 1; #end D("once", Once)

// macros
#macro L() #for (J, 1, 2) #end D("its own", J) #end
#declare J = 9; L() D("not changed", J)
#macro M(A, Out) #declare Out = A*2; #end #declare R = 0; M(3, R) D("by reference", R)
#macro Add(A) #declare A = A + 1; #end
#declare Q = 5; Add(Q) D("changed", Q) Add(Q + 0) D("not", Q) Add((Q)) D("not", Q) Add(-Q) D("not", Q)
#macro P(A) #local A = A + 1; D("local is the argument", A) #end P(Q) D("changed", Q)
#macro Doubled(A) #declare A = A*2; #end #declare V = <1, 2, 3>; Doubled(V) DV("vector", V) Doubled(V.y) DV("not", V)
#macro Dyn() D("the caller's", Z) #declare Z = Z + 1; #end
#macro Caller() #local Z = 10; Dyn() D("changed", Z) #end Caller() D("gone", defined(Z))
#macro Global() #declare G = 7; #end Global() D("global", G)
#macro Bk() #debug "before\n" #break #debug "never\n" #end Bk() #for (K, 0, 1) Bk() #debug "behind\n" #end
#macro If() #if (1) #break #end #debug "never\n" #end If()
#macro In() #while (1) #break #end #debug "after the loop\n" #end In()
#macro Three() 3 #end D("value", Three() + 1) D("value", Three()*2 + Three())
#macro Vector() <1, 2, 3> #end D("part", Vector().y)
#macro Local() #local Z = 3; Z #end D("local value", Local() + 1) #declare W = Local(); D("local value", W)
#macro Choose(N) #if (N) N #else 0 #end #end #debug str(Choose(3) + Choose(0), 0, 0) #debug "\n"
#macro Fact(I) #if (I = 0) 1 #else I*Fact(I - 1) #end #end #debug str(Fact(5), 0, 0) #debug "\n"
#macro Fib(n) #if (n < 2) #local r = n; #else #local r = Fib(n - 1) + Fib(n - 2); #end r #end D("recursion", Fib(10))
#macro Deep(N) #if (N > 0) Deep(N - 1) #end #end Deep(90)
#macro Inner(x1) x1 #end #macro Outer(y1) Inner(y1) + 1 #end D("nested", Outer(Inner(4)))
#macro Parts() #local K = 0; #while (K < 3) #declare K = K + 1; K #if (K < 3) , #end #end #end DV("parts", <Parts()>)
#macro Bare(A B) D("bare", B) #end Bare(1 2) Bare(1, 2,)
#macro Colour(C) C #end #declare C = Colour(rgb <1, 2, 3>); D("blue", C.blue)

// arrays
#declare Arr = array[2][3] { {1, 2, 3}, {4, 5, 6} }
D("dimensions", dimensions(Arr)) D("size", dimension_size(Arr, 1)) D("size", dimension_size(Arr, 2))
#declare Arr[1][2] = 60; D("element", Arr[1][2])
#declare Brr = Arr; #declare Brr[0][0] = 100; D("copied", Arr[0][0]) D("copy", Brr[1][1])
#declare E = array[3]; #declare E[1.7] = 5; D("cut", E[1]) D("defined", defined(E))
#ifdef (E[0]) #debug "never\n" #end #ifdef (E[1]) #debug "set\n" #end
#declare VA = array[2] { <1, 2, 3>, <4, 5, 6> } D("part", VA[1].y) DV("twice", VA[1]*2)
#declare Q = array[3] { 1, 2, 3 } Add(Q[1]) D("element changed", Q[1])
#macro Set(P) #declare P[0] = 7; #end Set(Q) D("array changed", Q[0])
#declare Names = array[2] { "one", "two" } #debug concat(Names[1], "\n")
#declare AA = array[2]; #declare AA[0] = array[2] { 5, 6 } #declare AA[1] = Q; #declare X = AA[0]; D("within", X[1])

// vectors of two to five parts, and colours, which have five
#macro D5(N, V) #debug concat(N, " ", vstr(5, V, " ", 0, 6), "\n") #end
#declare U2 = <1, 2>; #declare U4 = <1, 2, 3, 4>; #declare U5 = <1, 2, 3, 4, 5>; #declare Half = rgb 0.5;
D5("two and three", U2 + <1, 2, 3>) D5("four and a number", U4*2 - 1) D5("five", -U5/2) D5("a product", U5*x)
D("part u", U2.u) D("part v", U2.v) D("part t", U4.t) D("filter", U4.filter) D("transmit", U5.transmit)
D("length", vlength(U2)) D5("equal", (U2 = <1, 3>)) D5("turned", vrotate(U2, 90*z))
D5("colour and a number", Half + 0.25) D5("and a vector", Half*x + <0.1, 0.2, 0.3>)
D5("color", color 0.5) D5("rgbf", rgbf 0.5) D5("rgbt", rgbt U4) D5("rgbft", rgbft U5*2) D5("rgbf of three", rgbf <1, 1, 1>)
D5("parts", color red 1 green 0.5) D5("a changed part", color Half red 1 transmit 0.75)

// what the program gives
D("clock", clock) D("clock_on", clock_on) D("frame", frame_number) D("first", initial_frame) D("last", final_frame)
D("delta", clock_delta) D("width", image_width) D("height", image_height) D("version", version)
#ifdef (frame_number) #debug "declared\n" #end #ifdef (clock) #debug "never\n" #end
#declare frame_number = 7; D("frame", frame_number)
#undef Q #ifdef (Q) #debug "never\n" #end
light_source { 0, 1 }
