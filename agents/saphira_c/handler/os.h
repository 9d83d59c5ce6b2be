# An include file for makefiles as in the manual (4.2.2), with SAPHIRA set to the folder above
# handler: the names of the system, and the run-time path of the library for programs.
CONFIG = LINUX
X11D = /usr/
MOTIFD = /usr/
LLIBS = -Wl,-rpath,$(realpath $(SAPHIRA)/handler/obj)
