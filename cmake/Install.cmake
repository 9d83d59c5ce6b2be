# What is installed beside the programs, and the package that find_package(saphira) finds.
