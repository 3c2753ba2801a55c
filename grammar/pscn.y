/* The grammar of the language. Each action is one call; src/language gives it its meaning.
 *
 * Every block in braces is a flat list of items with an `error` item, and every brace belongs to such a block. So the
 * parser recovers in the block of the error, and tokens_recover, which counts braces, skips to where its next item
 * begins. The order of items in a block is checked where they get their meaning, which also makes errors clearer.
 */
%require "3.8"
%define api.pure full
%define api.prefix {pscn_}
%define api.token.prefix {PSCN_TOKEN_}
%define parse.error custom
%define lr.type canonical-lr
%define lr.default-reduction consistent
%param {struct language *language}

%code requires {
#include "language/state.h"
}

%code {
#include "language/objects.h"
#include "language/settings.h"
#include "language/symbols.h"
#include "language/tokens.h"

#define YYSTACK_USE_ALLOCA 0
#define YYMALLOC(size) language_alloc(language, size)
#define YYFREE(block) ((void)(block))

static int pscn_lex(PSCN_STYPE *value, struct language *language)
{
  const int token = tokens_next(language);
  value->place = language->tokens->last.place;
  return token;
}

/* The parser calls this only when its stack is full. */
static void pscn_error(struct language *language, const char *message)
{
  (void)message;
  language_limit(language, language->tokens->last.place, "this is nested too deeply");
}
}

%union {
  struct span place;
  int index;
  struct value *value, *list; /* a list: the last one first */
  struct texture *texture;
  struct node *node;
  struct declaration *declaration;
  const struct transform *transform;
}

%token END 0 "the end of the text" /* errors do not list tokens without such a name */
%token <place> NUMBER "a number" POINT "a vector" WORD "a name" STRING "a string"
%token <place> FOREIGN SHAPE REFUSED IGNORED COMPONENT
%token <place> START_SCENE START_SOLVER START_CONDITION START_RANGE START_FOR START_INDICES START_STRING START_ARGUMENTS START_DIRECTIVE
/* words.c: those from VERSION to DEFAULT are directives, to OBJECT they begin a statement, to SOLVER an item. */
%token <place> VERSION "#version" DECLARE "#declare" LOCAL "#local" DEFAULT "#default"
%token <place> GLOBAL_SETTINGS "global_settings" CAMERA "camera" LIGHT_SOURCE "light_source" BACKGROUND "background"
%token <place> BICUBIC_PATCH "bicubic_patch" UNION "union" OBJECT "object"
%token <place> ASSUMED_GAMMA "assumed_gamma" AMBIENT_LIGHT "ambient_light"
%token <place> LOCATION "location" DIRECTION "direction" RIGHT "right" UP "up" SKY "sky" ANGLE "angle" LOOK_AT "look_at"
%token <place> SHADOWLESS "shadowless"
%token <place> TYPE "type" FLATNESS "flatness" U_STEPS "u_steps" V_STEPS "v_steps" UV_VECTORS "uv_vectors"
%token <place> TRANSLATE "translate" ROTATE "rotate" SCALE "scale" MATRIX "matrix" TRANSFORM "transform"
%token <place> TEXTURE "texture" PIGMENT "pigment" FINISH "finish"
%token <place> AMBIENT "ambient" DIFFUSE "diffuse" BRILLIANCE "brilliance" PHONG "phong" PHONG_SIZE "phong_size"
%token <place> SPECULAR "specular" ROUGHNESS "roughness" SOLVER "solver"
%token <place> COLOR "color" RGB "rgb" X "x" Y "y" Z "z"
%token <place> RED "red" GREEN "green" BLUE "blue" FILTER "filter"
%token COMPARISON
%token <place> CONSTANT "a constant" FUNCTION "a function" DEFINED "defined" ARRAY "array"
%token <place> DEPRECATED "deprecated" ONCE "once" /* before a name whose use makes POV-Ray warn */

%type <value> expression condition name named string value colour spaced shade solid any array quantity
%type <list> list parts indices more_indices target arguments
%type <index> camera_vector
%type <place> part component solver method modifier
%type <texture> texture_block pigment_block finish_block part_block surface
%type <node> object patch union copy
%type <declaration> declare
%type <transform> transform transform_block

/* A declaration that an error ends: its name must not be reported as unknown as well. */
%destructor { declare_broken(language, $$); } <declaration>

/* Where an expression may be followed by the next item, "+" and "-" belong to the expression, as in POV-Ray. */
%precedence ITEM
%precedence <place> ';' '{'
%precedence RED GREEN BLUE FILTER
%right '?' ':'
%left '&' '|'
%left <place> '<' '>' '=' COMPARISON
%left <place> '+' '-'
%left '*' '/'
%precedence SIGN
%precedence <place> '!'
%precedence '.'

%token <place> '}' '(' ')' '[' ']'

%%

/* A text, or what stands behind a directive or the name of a macro. Of these, the token behind the last is not read. */
input:
    START_SCENE statements
  | START_SOLVER solver
  | START_CONDITION '(' condition ')'          { language->list = $3; YYACCEPT; }
  | START_RANGE '(' expression ',' expression ')' { language->list = value_before(value_before(NULL, $5), $3); YYACCEPT; }
  | START_FOR '(' WORD ',' list ')'
    { language->list = value_before(value_reversed($5), value_of(language, VALUE_NONE, $3)); YYACCEPT; }
  | START_INDICES expression ']' more_indices ')'
    { language->list = value_before(value_reversed($4), $2); YYACCEPT; }
  | START_DIRECTIVE directive                  { YYACCEPT; }
  | START_STRING string                        { language->list = $2; YYACCEPT; }
  | START_ARGUMENTS '(' arguments ')'          { language->list = value_reversed($3); YYACCEPT; }
  ;

string:
    STRING                                     { $$ = value_of_string(language, $1); }
  | WORD                                       { $$ = value_named(language, $1); }
  | FUNCTION '(' list ')'                      { $$ = value_function(language, $3, $1, span_join($1, $4)); }
  ;

arguments:
    %empty                                     { $$ = NULL; }
  | arguments any comma                        { $$ = value_before($1, $2); }
  ;

statements: %empty | statements statement;
statement:
    GLOBAL_SETTINGS '{' global_items '}'
  | CAMERA '{' { camera_begin(language, $1); } camera_items '}' { camera_end(language); }
  | LIGHT_SOURCE '{' { light_begin(language, $1); } light_items '}' { light_end(language); }
  | BACKGROUND '{' { background_begin(language, $1); } background_items '}' { background_end(language); }
  | object                                     { scene_add(language, $1); }
  | solver                                     { solver_misplaced(language, $1); }
  | foreign
  ;

/* May stand between the items of every block. */
foreign:
    IGNORED                                    { tokens_pass(language); }
  | FOREIGN                                    { language_lacks(language, $1, $1); tokens_pass(language); }
  | wrong
  ;

/* The parser goes on with the token at which tokens_recover stops. */
wrong: error
    {
      yyerrok;
      yyclearin;
      if (!tokens_recover(language)) YYABORT;
    }
  ;

directive:
    VERSION value semicolon                    { language_version(language, $2); }
  | DEFAULT '{' default_items '}'
  | declared_value semicolon
  | declare solid                              { declare_value(language, $1, $2); value_last(language, $2); } semicolon
  | declare texture_block                      { declare_texture(language, $1, $2); } layers semicolon
    { language->layered = NULL; }
  ;
default_items: %empty | default_items default_item;
default_item:
    surface                                    { texture_set_default(language, $1); }
  | foreign
  ;
declared_value: declare shade ';'              { declare_value(language, $1, $2); }
  | declare shade %prec ITEM                   { declare_open(language, $1, $2); };
layers: %empty | layers TEXTURE { layer_begin(language, $2); } '{' texture_items '}' { layer_end(language, $6); };
/* Declarations of anything but a value. */
solid:
    object                                     { $$ = value_of_object(language, $1); }
  | part_block                                 { $$ = value_of_texture(language, $1); }
  | transform_block                            { $$ = value_of_transform(language, $1); }
  | array
  ;
/* Whatever has a value. */
any: colour %prec ITEM | solid | texture_block { $$ = value_of_texture(language, $1); };
declare: DECLARE old target '='                { $$ = declare_begin(language, value_reversed($3), NULL); }
  | LOCAL old target '='                       { $$ = declare_begin(language, value_reversed($3), &$1); };
target: WORD                                   { $$ = value_before(NULL, value_of(language, VALUE_NONE, $1)); }
  | target '[' expression ']'                  { $$ = value_before($1, $3); };
old: %empty | DEPRECATED STRING | DEPRECATED ONCE STRING;
semicolon: %empty %prec ITEM | ';';

/* ---- arrays ---- */

array:
    ARRAY indices %prec ITEM                   { array_begin(language, value_reversed($2), $1); $$ = array_end(language); }
  | ARRAY indices '{' { array_begin(language, value_reversed($2), $1); } elements '}'
    { array_row_end(language, $6); $$ = array_end(language); }
  ;
indices: '[' expression ']'                    { $$ = value_before(NULL, $2); }
  | indices '[' expression ']'                 { $$ = value_before($1, $3); };
more_indices: %empty                           { $$ = NULL; }
  | more_indices '[' expression ']'            { $$ = value_before($1, $3); };
elements: %empty | elements element comma;
element:
    any                                        { array_given(language, $1); value_last(language, $1); }
  | '{' { array_row(language, $1); } elements '}' { array_row_end(language, $4); }
  | wrong
  ;

/* ---- values ---- */

/* A complete value, and a complete colour. */
value: expression %prec ITEM                   { $$ = value_last(language, $1); };
shade: colour %prec ITEM                       { $$ = value_last(language, $1); };

expression:
    NUMBER                                     { $$ = value_of_number(language, *language->number, $1); }
  | POINT                                      { $$ = value_of_vector(language, language->number, $1); }
  | STRING                                     { $$ = value_of_string(language, $1); }
  | named
  | X                                          { $$ = value_axis(language, 0, $1); }
  | Y                                          { $$ = value_axis(language, 1, $1); }
  | Z                                          { $$ = value_axis(language, 2, $1); }
  | CONSTANT                                   { $$ = value_constant(language, $1); }
  | FUNCTION '(' list ')'                      { $$ = value_function(language, $3, $1, span_join($1, $4)); }
  | DEFINED '(' WORD ')'                       { $$ = value_defined(language, $3, span_join($1, $4)); }
  | '(' condition ')'                          { $$ = value_unary(language, '(', $2, span_join($1, $3)); }
  | '<' parts '>'                              { $$ = value_of_parts(language, $2, span_join($1, $3)); }
  | '<' parts ',' '>'                          { $$ = value_of_parts(language, $2, span_join($1, $4)); }
  | expression '+' expression                  { $$ = value_binary(language, '+', $1, $3); }
  | expression '-' expression                  { $$ = value_binary(language, '-', $1, $3); }
  | expression '*' expression                  { $$ = value_binary(language, '*', $1, $3); }
  | expression '/' expression                  { $$ = value_binary(language, '/', $1, $3); }
  | '-' expression %prec SIGN                  { $$ = value_unary(language, '-', $2, span_join($1, $2->place)); }
  | '+' expression %prec SIGN                  { $$ = value_unary(language, '+', $2, span_join($1, $2->place)); }
  | '!' expression                             { $$ = value_unary(language, '!', $2, span_join($1, $2->place)); }
  | expression '.' component                   { $$ = value_component(language, $1, $3); }
  ;
component: X | Y | Z | COMPONENT | part;
part: RED | GREEN | BLUE | FILTER;
/* The comma between two may be missing. */
parts: expression %prec ITEM                   { $$ = value_before(NULL, $1); }
  | parts expression %prec ITEM                { $$ = value_before($1, $2); }
  | parts ',' expression %prec ITEM            { $$ = value_before($1, $3); };

name: WORD                                     { $$ = value_named(language, $1); };
named: name | name indices                     { $$ = value_element(language, $1, $2, $1->place); };
list: expression                               { $$ = value_before(NULL, $1); }
  | list ',' expression                        { $$ = value_before($1, $3); };
comma: %empty %prec ITEM | ',';

/* In parentheses only. */
condition:
    expression
  | condition '<' condition                    { $$ = value_binary(language, '<', $1, $3); }
  | condition '>' condition                    { $$ = value_binary(language, '>', $1, $3); }
  | condition '=' condition                    { $$ = value_binary(language, '=', $1, $3); }
  | condition COMPARISON condition             { $$ = value_binary(language, comparison_at(language, $2), $1, $3); }
  | condition '&' condition                    { $$ = value_binary(language, '&', $1, $3); }
  | condition '|' condition                    { $$ = value_binary(language, '|', $1, $3); }
  | condition '?' { choice_begin(language, $1); } condition ':' { choice_else(language, $1); } condition
                                               { $$ = choice_end(language, $1, $4, $7); }
  ;

/* A plain vector or number is a colour wherever POV-Ray takes it for one. */
colour:
    expression %prec ITEM
  | COLOR expression %prec ITEM                { $$ = value_color(language, $2, span_join($1, $2->place)); }
  | spaced
  | COLOR spaced                               { $$ = value_placed($2, span_join($1, $2->place)); }
  | expression part expression %prec ITEM      { $$ = value_part(language, $1, $2, $3); }
  | part expression %prec ITEM                 { $$ = value_part(language, NULL, $1, $2); }
  | COLOR part expression %prec ITEM           { $$ = value_part(language, NULL, $2, $3); }
  | colour part expression %prec ITEM          { $$ = value_part(language, $1, $2, $3); }
  ;
spaced: RGB expression %prec ITEM              { $$ = value_rgb(language, $1, $2); };

/* ---- settings, camera, lights ---- */

global_items: %empty | global_items global_item;
global_item:
    ASSUMED_GAMMA value                        { global_gamma(language, $1, $2); }
  | ASSUMED_GAMMA RGB                          { global_gamma(language, $2, NULL); }
  | AMBIENT_LIGHT shade                        { global_ambient(language, $2); }
  | solver                                     { global_solver(language); }
  | foreign
  ;

camera_items: %empty | camera_items camera_item;
camera_item:
    camera_vector value                        { camera_vector(language, $1, $2); }
  | ANGLE value                                { camera_angle(language, $2); }
  | transform                                  { camera_transform(language, $1); }
  | foreign
  ;

camera_vector:
    LOCATION                                   { $$ = CAMERA_LOCATION; }
  | DIRECTION                                  { $$ = CAMERA_DIRECTION; }
  | RIGHT                                      { $$ = CAMERA_RIGHT; }
  | UP                                         { $$ = CAMERA_UP; }
  | SKY                                        { $$ = CAMERA_SKY; }
  | LOOK_AT                                    { $$ = CAMERA_LOOK_AT; }
  ;

/* The position, then the colour, then the rest. */
light_items: %empty | light_items light_item;
light_item:
    shade comma                                { light_value(language, $1); }
  | SHADOWLESS                                 { light_shadowless(language, $1); }
  | transform                                  { light_transform(language, $1); }
  | foreign
  ;

background_items: %empty | background_items background_item;
background_item:
    shade                                      { background_value(language, $1); }
  | foreign
  ;

/* ---- objects ---- */

object: patch | union | copy
  | SHAPE                                      { $$ = shape_pass(language, $1); }
  ;

/* Settings, then 16 points, then modifiers. */
patch: BICUBIC_PATCH '{' { patch_begin(language, $1); } patch_items '}'
    { patch_end(language); $$ = node_end(language, $5); };
patch_items: %empty | patch_items patch_item;
patch_item:
    ','
  | value                                      { patch_point(language, $1); }
  | TYPE value                                { patch_number(language, PATCH_TYPE, $1, $2); }
  | FLATNESS value                            { patch_number(language, PATCH_FLATNESS, $1, $2); }
  | U_STEPS value                             { patch_number(language, PATCH_U_STEPS, $1, $2); }
  | V_STEPS value                             { patch_number(language, PATCH_V_STEPS, $1, $2); }
  | UV_VECTORS value comma value comma value comma value /* without uv_mapping they have no effect */
  | modifier                                   { patch_modified(language); }
  | solver                                     { patch_solver(language); }
  | foreign
  ;

/* The objects, then modifiers. */
union: UNION '{' { node_begin(language, $1); } union_items '}' { $$ = node_end(language, $5); };
union_items: %empty | union_items union_item;
union_item:
    object                                     { union_add(language, $1); }
  | modifier                                   { union_modified(language); }
  | solver                                     { solver_misplaced(language, $1); }
  | foreign
  ;

/* The object, then modifiers. */
copy: OBJECT '{' { node_begin(language, $1); } copy_items '}' { copy_end(language); $$ = node_end(language, $5); };
copy_items: %empty | copy_items copy_item;
copy_item:
    named                                      { copy_named(language, value_last(language, $1)); }
  | object                                     { copy_object(language, $1); }
  | modifier                                   { copy_modified(language, $1); }
  | solver                                     { solver_misplaced(language, $1); }
  | foreign
  ;

modifier:
    transform                                  { node_transform(language, $1), $$ = language->transform_place; }
  | surface                                    { $$ = $1->place, node_texture(language, $1); }
  ;

transform:
    TRANSLATE value                           { $$ = transform_translate(language, $1, $2); }
  | ROTATE value                              { $$ = transform_rotate(language, $1, $2); }
  | SCALE value                               { $$ = transform_scale(language, $1, $2); }
  | MATRIX '<' parts '>'                      { $$ = transform_matrix(language, span_join($1, $4), $3); }
  | MATRIX POINT                              { $$ = transform_matrix(language, $2, NULL); }
  | TRANSFORM name                            { $$ = transform_named(language, value_last(language, $2)); }
  | transform_block
  ;
transform_block: TRANSFORM '{' { transforms_begin(language); } transform_items '}'
    { $$ = transforms_end(language, span_join($1, $5)); };
transform_items: %empty | transform_items transform_item;
transform_item:
    name        { transforms_add(language, transform_named(language, value_last(language, $1))); }
  | transform                                  { transforms_add(language, $1); }
  | wrong
  ;

/* ---- textures ---- */

surface: texture_block | part_block;
part_block: pigment_block | finish_block;

texture_block: TEXTURE '{' { texture_begin(language, $1, TEXTURE_ALL); } texture_items '}'
    { $$ = texture_end(language, $5); };
texture_items: %empty | texture_items texture_item;
texture_item:
    named                                      { texture_named(language, value_last(language, $1)); }
  | part_block                                 { texture_merge(language, $1); }
  | transform                                  { texture_moved(language); }
  | foreign
  ;

pigment_block: PIGMENT '{' { texture_begin(language, $1, TEXTURE_PIGMENT); } pigment_items '}'
    { $$ = texture_end(language, $5); };
pigment_items: %empty | pigment_items pigment_item;
pigment_item:
    shade                                      { pigment_value(language, $1); }
  | transform                                  { texture_moved(language); }
  | foreign
  ;

finish_block: FINISH '{' { texture_begin(language, $1, TEXTURE_FINISH); } finish_items '}'
    { $$ = texture_end(language, $5); };
finish_items: %empty | finish_items finish_item;
finish_item:
    named                                      { texture_named(language, value_last(language, $1)); }
  | AMBIENT shade                              { finish_ambient(language, $2); }
  | DIFFUSE value                              { finish_number(language, PART_DIFFUSE, $2); }
  | BRILLIANCE value                           { finish_number(language, PART_BRILLIANCE, $2); }
  | PHONG value                                { finish_number(language, PART_PHONG, $2); }
  | PHONG_SIZE value                           { finish_number(language, PART_PHONG_SIZE, $2); }
  | SPECULAR value                             { finish_number(language, PART_SPECULAR, $2); }
  | ROUGHNESS value                            { finish_number(language, PART_ROUGHNESS, $2); }
  | foreign
  ;

/* ---- solvers: all words are plain here ---- */

solver: method | method '{' solver_items '}' { $$ = span_join($1, $4); };
method: SOLVER WORD                            { solver_begin(language, $2); $$ = span_join($1, $2); };
solver_items: %empty | solver_items solver_item;
solver_item:
    WORD quantity                              { solver_quantity(language, $1, value_last(language, $2)); }
  | WORD WORD                                  { solver_word(language, $1, $2); }
  | wrong
  ;

/* A name may be a keyword of the item. So a declared name that is part of an expression must be in parentheses. */
quantity:
    NUMBER                                     { $$ = value_of_number(language, *language->number, $1); }
  | '(' expression ')'                         { $$ = value_unary(language, '(', $2, span_join($1, $3)); }
  | quantity '+' quantity                      { $$ = value_binary(language, '+', $1, $3); }
  | quantity '-' quantity                      { $$ = value_binary(language, '-', $1, $3); }
  | quantity '*' quantity                      { $$ = value_binary(language, '*', $1, $3); }
  | quantity '/' quantity                      { $$ = value_binary(language, '/', $1, $3); }
  | '-' quantity %prec SIGN                    { $$ = value_unary(language, '-', $2, span_join($1, $2->place)); }
  | '+' quantity %prec SIGN                    { $$ = value_placed($2, span_join($1, $2->place)); }
  ;

%%

static int yyreport_syntax_error(const yypcontext_t *context, struct language *language)
{
  enum { MOST = 128 };
  yysymbol_kind_t kinds[MOST];
  const char *names[MOST];
  const int count = yypcontext_expected_tokens(context, kinds, MOST);
  for (int k = 0; k < count; k++) names[k] = yysymbol_name(kinds[k]);
  syntax_error(language, yypcontext_token(context) == YYSYMBOL_WORD, names,
               count > 0 ? count : 0);
  return 0;
}
