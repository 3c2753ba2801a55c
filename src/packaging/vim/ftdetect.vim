autocmd BufNewFile,BufRead *.pscn setfiletype pscn
