# Completion of flightwatt in bash: stages, their options as the programs themselves list them, and files.

_flightwatt_files() {
    local pattern=$1 cur=$2
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <({ compgen -d -- "$cur"; compgen -f -- "$cur" | grep -E "$pattern"; } | sort -u)
}

_flightwatt() {
    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} program stage=() kind
    COMPREPLY=()
    program=${COMP_WORDS[0]}
    if [[ ${program##*/} == flightwatt ]]; then
        if ((COMP_CWORD == 1)); then
            mapfile -t COMPREPLY < <(compgen -W "help $("$program" --list-stages 2>/dev/null | cut -f 1)" -- "$cur")
            return
        fi
        stage=("${COMP_WORDS[1]}")
        if [[ ${stage[0]} == help ]]; then
            local pages
            pages=$("$program" help 2>/dev/null | sed -n 's/^  \([a-z-]\{1,\}\) .*/\1/p')
            ((COMP_CWORD == 2)) && mapfile -t COMPREPLY < <(compgen -W "$pages" -- "$cur")
            return
        fi
    fi
    local options
    options=$("$program" "${stage[@]}" --list-options 2>/dev/null) || return
    kind=$(awk -F '\t' -v option="$prev" '$1 == option || ($2 != "" && $2 == option) { print $3; exit }' <<<"$options")
    case $kind in
    input | output) _flightwatt_files . "$cur" ;;
    value) ;;
    *)
        if [[ $cur == -* ]]; then
            mapfile -t COMPREPLY < <(compgen -W "$(cut -f 1 <<<"$options")" -- "$cur")
        else
            _flightwatt_files '\.(toml|csv|cfg|data|log|LOG|tlm|TLM)(\.(gz|bz2|xz|zst))?$' "$cur"
        fi
        ;;
    esac
}

# The programs of the stages complete as well: flightwatt-fit.
_flightwatt_programs() {
    local stage names=(flightwatt)
    while read -r stage; do names+=("flightwatt-$stage"); done < <(flightwatt --list-stages 2>/dev/null | cut -f 1)
    complete -F _flightwatt "${names[@]}"
}
_flightwatt_programs
