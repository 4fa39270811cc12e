// Nothing but a library linked with -ffast-math: with g++ up to 12 and clang up to 14 the start-up code that comes with
// that option sets FTZ and DAZ for the thread that loads the library, and so for all threads it starts.
extern "C" double fast_math_library_half(double value) { return 0.5 * value; }
