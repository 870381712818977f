# The man page and the shells' completions, from what the program itself says with --help:
#   cmake -DPROGRAM=colod -DVERSION=1.2.3 -DOUT=folder -P manual.cmake
# CLI11 writes "  names TYPE" and the text in column 30, or on a line of its own where the names reach that far.
cmake_minimum_required(VERSION 3.25)
set(column 30)
string(REPEAT " " ${column} indent)

function(help_of out)
  execute_process(COMMAND ${PROGRAM} ${ARGN} --help OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# Takes the first line off `text`.
macro(next_line line text)
  string(FIND "${${text}}" "\n" end)
  string(SUBSTRING "${${text}}" 0 ${end} ${line})
  math(EXPR end "${end} + 1")
  string(SUBSTRING "${${text}}" ${end} -1 ${text})
endmacro()

# Backslashes, quotes and leading dots mean something to troff.
function(troff out text)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "^([.'])" "\\\\&\\1" text "${text}")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# An option or operand of a subcommand into the four texts.
macro(add_entry)
  string(REGEX REPLACE " REQUIRED" "" shown "${head}")
  troff(shown "${shown}")
  troff(said "${said}")
  string(APPEND man ".TP\n.B ${shown}\n${said}\n")
  if(head MATCHES "--([a-z0-9-]+)")
    set(long ${CMAKE_MATCH_1})
    set(choices "")
    if(head MATCHES ":\\{([^}]*)\\}")
      string(REPLACE "," " " choices "${CMAKE_MATCH_1}")
      string(APPEND bash_choices "    \"${command} --${long}\") words=\"${choices}\" ;;\n")
    endif()
    string(APPEND options " --${long}")
    string(REPLACE "'" "\\'" quoted "${said_plain}")
    string(APPEND fish "complete -c colod -n '__fish_seen_subcommand_from ${command}' -l ${long}")
    if(NOT choices STREQUAL "")
      string(APPEND fish " -x -a '${choices}'")
    elseif(head MATCHES " ")
      string(APPEND fish " -r")
    endif()
    string(APPEND fish " -d '${quoted}'\n")
  endif()
endmacro()

set(man ".TH COLOD 1 \"\" \"colod ${VERSION}\" \"User Commands\"\n.SH NAME\ncolod \\- consistent levels of detail for buildings\n")
string(APPEND man ".SH SYNOPSIS\n.B colod\n.I COMMAND\n[\\fIOPTION\\fR ...] [\\fIFILE\\fR ...]\n.SH DESCRIPTION\n")
set(bash_options "")
set(bash_choices "")
set(fish "complete -c colod -n __fish_use_subcommand -f\n")
set(commands "")

help_of(text)
string(REGEX MATCH "^colod: ([^\n]*)\n" _ "${text}")
string(APPEND man "Makes ${CMAKE_MATCH_1}.\n.B colod\n.I COMMAND\n.B \\-\\-help\nsays the same as this page.\n")
string(REGEX MATCH "\nSubcommands:\n(.*)$" _ "${text}")
set(list "${CMAKE_MATCH_1}")
while(list MATCHES "\n")
  next_line(line list)
  if(line MATCHES "^  ([a-z]+) +(.*)$")
    set(command ${CMAKE_MATCH_1})
    set(said_plain "${CMAKE_MATCH_2}")
    list(APPEND commands ${command})
    troff(said "${said_plain}")
    string(APPEND man ".SH COLOD ${command}\n${said}\n")
    string(REPLACE "'" "\\'" quoted "${said_plain}")
    string(APPEND fish "complete -c colod -n __fish_use_subcommand -a ${command} -d '${quoted}'\n")
    help_of(text ${command})
    set(options "")
    set(head "")
    while(text MATCHES "\n")
      next_line(line text)
      string(LENGTH "${line}" length)
      if(line MATCHES "^${indent}(.*)$" AND NOT head STREQUAL "")
        set(said_plain "${CMAKE_MATCH_1}")
        set(said "${said_plain}")
        add_entry()
        set(head "")
      elseif(line MATCHES "^  [-A-Z]")
        if(text MATCHES "^${indent}")  # the text follows
          string(STRIP "${line}" head)
        else()
          string(SUBSTRING "${line}" 0 ${column} head)
          string(STRIP "${head}" head)
          set(said_plain "")
          if(length GREATER column)
            string(SUBSTRING "${line}" ${column} -1 said_plain)
          endif()
          set(said "${said_plain}")
          add_entry()
          set(head "")
        endif()
      endif()
    endwhile()
    string(APPEND bash_options "    ${command}) words=\"${options}\" ;;\n")
  endif()
endwhile()

string(APPEND man ".SH EXIT STATUS\n0 all done and nothing lost; 1 something failed or was lost, the rest is written and complete; 2 usage; 3 input; 4 a stage; 5 output.\n")
list(JOIN commands " " commands)
set(bash "_colod() {
  local current=\${COMP_WORDS[COMP_CWORD]} words=
  COMPREPLY=()
  if [ \"$COMP_CWORD\" = 1 ]; then
    words=\"${commands} --help --version\"
  elif [[ $current == -* ]]; then
    case \${COMP_WORDS[1]} in
${bash_options}    esac
  else
    case \"\${COMP_WORDS[1]} \${COMP_WORDS[COMP_CWORD-1]}\" in
${bash_choices}    esac
  fi
  [ -z \"$words\" ] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")
}
")
file(WRITE ${OUT}/colod.1 "${man}")
file(WRITE ${OUT}/colod.bash "${bash}complete -o default -F _colod colod\n")
# zsh runs bash's, and falls back to files as that does.
file(WRITE ${OUT}/_colod "#compdef colod
autoload -Uz bashcompinit && bashcompinit
${bash}complete -o default -F _colod colod
")
file(WRITE ${OUT}/colod.fish "${fish}")
