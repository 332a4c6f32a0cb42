# Completes command lines of spherule in bash. @TABLES@ below are made from the program's help.
_spherule() {
    local -A commands options values words
@TABLES@
    # The command of ctl follows the address of the server.
    local -A places=(["ctl/"]=1)
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command= place=0 word index
    # The words before the current one: commands, and the number of arguments since the last command.
    for ((index = 1; index < COMP_CWORD; ++index)); do
        word=${COMP_WORDS[index]}
        if [[ $word == -* ]]; then
            # The word behind an option that takes a value is no argument.
            if [[ -n ${values[$word]+set} && ${COMP_WORDS[index + 1]} != = ]]; then ((++index)); fi
        elif [[ $word == [=:] ]]; then
            ((++index))  # bash splits --quality=fast and ws://host:port, too
        elif [[ " ${commands[$command/]-} " == *" $word "* ]]; then
            command+=${command:+ }$word place=0
        else
            ((++place))
        fi
    done
    if [[ $current == = ]]; then
        current=
    elif [[ $before == = ]]; then
        before=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    COMPREPLY=()
    if [[ $before == -* && -n ${values[$before]+set} ]]; then
        # No choices: bash completes names of files.
        mapfile -t COMPREPLY < <(compgen -W "${values[$before]}" -- "$current")
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "${options[$command/]} ${options[/]}" -- "$current")
    else
        word="${commands[$command/]-} "
        [[ $place != "${places[$command/]-0}" ]] || word+=${words[$command/]-}
        mapfile -t COMPREPLY < <(compgen -W "$word" -- "$current")
    fi
}
complete -o bashdefault -o default -F _spherule spherule
