# Prints the fragments of C++ of pages as functions that compile where what stands around them is given.
/^ *```/ {
  if (inside) print "  }();"
  inside = !inside && /```cpp/
  if (inside) print "  [&] {"
  next
}
inside
