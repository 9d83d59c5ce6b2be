# Writes the fenced blocks of a page that follow the name of a file, such as `services/x/y.cpp`, under
# the folder `into`, without their indent. Prints their names.
/`[A-Za-z0-9_\/.-]+\.[a-z]+`/ && !inside {
  match($0, /`[A-Za-z0-9_\/.-]+\.[a-z]+`/)
  name = substr($0, RSTART + 1, RLENGTH - 2)
  fresh = 3
}
/^ *```/ {
  inside = !inside
  indent = index($0, "`")
  if (inside && fresh > 0) {
    file = into "/" name
    folder = file
    sub(/\/[^\/]*$/, "", folder)
    system("mkdir -p '" folder "'")
    printf "" > file
    print name
  } else if (file != "") {
    close(file)
    file = ""
  }
  next
}
inside && file != "" { print substr($0, indent) >> file }
!inside && !/^ *$/ { fresh-- }
