# fish completion for loopbench: the program lists the words that can follow; otherwise files
complete -c loopbench -a '(loopbench complete (commandline -opc) "$(commandline -ct)" 2>/dev/null)'
