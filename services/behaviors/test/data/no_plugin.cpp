// A shared library that is no plug-in: for the test of what is said of it.
// NOLINTNEXTLINE(readability-identifier-naming): as libraries of others name theirs
extern "C" int something_else() {
  return 7;
}
