# Writes OUTPUT: a table of every kernel source under ROOT, by its path below ROOT.
# Called by the build (see CMakeLists.txt); host/cl/kernel_source.h declares the table.
file(GLOB_RECURSE FILES RELATIVE ${ROOT} ${ROOT}/*.h ${ROOT}/*.cl ${ROOT}/*.def)
list(SORT FILES)
set(TEXT "#include \"cl/kernel_source.h\"\n\nnamespace wavelobe {\nconst std::vector<KernelFile>& embedded_kernel_files() {\n    static const std::vector<KernelFile> files = {\n")
foreach(FILE ${FILES})
  file(READ ${ROOT}/${FILE} CONTENT)
  string(APPEND TEXT "        {\"${FILE}\", R\"KERNEL(${CONTENT})KERNEL\"},\n")
endforeach()
string(APPEND TEXT "    };\n    return files;\n}\n}  // namespace wavelobe\n")
file(WRITE ${OUTPUT} "${TEXT}")
