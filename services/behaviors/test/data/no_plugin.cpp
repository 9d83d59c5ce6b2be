// A shared library that is no plug-in: for the test of its error message.
// NOLINTNEXTLINE(readability-identifier-naming): as in other libraries
extern "C" int something_else() {
  return 7;
}
