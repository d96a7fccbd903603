# Completion of flightwatt in fish: stages, their options as the programs themselves list them, and files.

function __flightwatt_words
    commandline -opc
end

function __flightwatt_needs_stage
    test (count (__flightwatt_words)) -eq 1
end

function __flightwatt_of_help
    set -l words (__flightwatt_words)
    test (count $words) -eq 2; and test "$words[2]" = help
end

function __flightwatt_of_stage
    set -l words (__flightwatt_words)
    test (count $words) -ge 2; and test "$words[2]" != help
end

# The kind of what the word before takes: flag, value, input or output.
function __flightwatt_kind
    set -l words (__flightwatt_words)
    set -l last $words[-1]
    for line in (command $words[1] $words[2] --list-options 2>/dev/null)
        set -l fields (string split \t -- $line)
        if contains -- "$last" $fields[1] $fields[2]
            echo $fields[3]
            return
        end
    end
end

function __flightwatt_stages
    set -l words (__flightwatt_words)
    printf "help\ta stage's options\n"
    $words[1] --list-stages 2>/dev/null
end

function __flightwatt_pages
    set -l words (__flightwatt_words)
    $words[1] help 2>/dev/null | string replace -rf '^  ([a-z-]+) .*' '$1'
end

function __flightwatt_arguments
    set -l words (__flightwatt_words)
    set -l current (commandline -ct)
    switch (__flightwatt_kind)
        case input output
            __fish_complete_path $current
        case value
        case '*'
            if string match -q -- '-*' $current
                for line in (command $words[1] $words[2] --list-options 2>/dev/null)
                    set -l fields (string split \t -- $line)
                    printf '%s\t%s\n' $fields[1] $fields[5]
                end
            else
                __fish_complete_path $current | string match -r '^[^\t]*(?:/|\.(?:toml|csv|cfg|data|log|LOG|tlm|TLM)(?:\.(?:gz|bz2|xz|zst))?)(?=\t|$)'
            end
    end
end

complete -c flightwatt -f
complete -c flightwatt -n __flightwatt_needs_stage -a '(__flightwatt_stages)'
complete -c flightwatt -n __flightwatt_of_help -a '(__flightwatt_pages)'
complete -c flightwatt -n __flightwatt_of_stage -a '(__flightwatt_arguments)'
