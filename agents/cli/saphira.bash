# Completion for bash: installed to share/bash-completion/completions/saphira. In a clone:
#   source agents/cli/saphira.bash
_saphira() {
  local candidates
  candidates=$("${COMP_WORDS[0]}" complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  mapfile -t COMPREPLY < <(compgen -W "$candidates" -- "${COMP_WORDS[COMP_CWORD]}")
}
complete -o default -F _saphira saphira ./saphira
