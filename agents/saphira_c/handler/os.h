# What makefiles in the manual's shape include (4.2.2), with SAPHIRA set to the folder above handler:
# the names of the system, and how programs find the library when they run.
CONFIG = LINUX
X11D = /usr/
MOTIFD = /usr/
LLIBS = -Wl,-rpath,$(realpath $(SAPHIRA)/handler/obj)
