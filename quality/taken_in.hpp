// Files that a program holds as they were when it was built.
#pragma once

// SCAN2FEA_TAKE_IN(schema, "FILE"); declares `scan2fea_schema` and `scan2fea_schema_end`: the assembler takes the file
// in as it is, in no time however large it is. CMake's OBJECT_DEPENDS must name it.
#define SCAN2FEA_TAKE_IN(name, file) \
  asm(".section .rodata\n"           \
      ".global scan2fea_" #name      \
      "\n"                           \
      ".hidden scan2fea_" #name      \
      "\n"                           \
      "scan2fea_" #name              \
      ":\n"                          \
      ".incbin \"" file              \
      "\"\n"                         \
      ".global scan2fea_" #name      \
      "_end\n"                       \
      ".hidden scan2fea_" #name      \
      "_end\n"                       \
      "scan2fea_" #name              \
      "_end:\n"                      \
      ".byte 0\n"                    \
      ".previous\n");                \
  extern "C" const char scan2fea_##name[], scan2fea_##name##_end[]
