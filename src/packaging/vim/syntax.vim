" Vim syntax of pscn's scenes, made from the tables of the language.
if exists("b:current_syntax") | finish | endif
syntax case match
syntax keyword pscnForeign {{#foreign}}{{^first}} {{/first}}{{word}}{{/foreign}}
syntax keyword pscnStatement {{#statements}}{{^first}} {{/first}}{{word}}{{/statements}}
syntax keyword pscnItem {{#items}}{{^first}} {{/first}}{{word}}{{/items}}
syntax keyword pscnValue {{#values}}{{^first}} {{/first}}{{word}}{{/values}}
syntax match pscnDirective "#\s*\({{#directives}}{{^first}}\|{{/first}}{{word}}{{/directives}}\)\>"
syntax match pscnNumber "\(\<\d\+\.\=\d*\|\.\d\+\)\([eE][-+]\=\d\+\)\="
syntax region pscnString start=+"+ end=+"+ oneline
syntax match pscnComment "//.*"
syntax region pscnComment start="/\*" end="\*/" contains=pscnComment
syntax keyword pscnSolverWord contained {{#solver_words}}{{^first}} {{/first}}{{word}}{{/solver_words}}
syntax keyword pscnSolverName solver nextgroup=pscnSolver skipwhite skipempty
syntax match pscnSolver "\w\+" contained nextgroup=pscnSolverBlock skipwhite skipempty
syntax region pscnSolverBlock start="{" end="}" contained contains=pscnSolverWord,pscnNumber,pscnComment
highlight default link pscnForeign Error
highlight default link pscnStatement Statement
highlight default link pscnItem Type
highlight default link pscnValue Constant
highlight default link pscnDirective PreProc
highlight default link pscnNumber Number
highlight default link pscnString String
highlight default link pscnComment Comment
highlight default link pscnSolver Identifier
highlight default link pscnSolverName Statement
highlight default link pscnSolverWord Type
let b:current_syntax = "pscn"
