/* The grammar of the language. Each action is one call; what things mean is in src/language.
 *
 * Every block in braces is a flat list of items with an `error` item, and every brace belongs to such a block. So the
 * parser recovers in the block in which the error stands, and tokens_recover, which counts braces, skips to where its
 * next item begins. What may follow what within a block is checked where items have a meaning, which also makes for
 * clearer errors.
 */
%require "3.8"
%define api.pure full
%define api.prefix {pscn_}
%define api.token.prefix {PSCN_TOKEN_}
%define api.location.type {struct place}
%define parse.error custom
%define lr.type canonical-lr
%define lr.default-reduction consistent
%locations
%param {struct language *language}

%code requires {
#include "language/camera.h"
#include "language/objects.h"
#include "language/settings.h"
#include "language/solver_statement.h"
}

%code {
#include "base/memory.h"
#include "language/syntax_errors.h"
#include "language/tokens.h"

#define YYLLOC_DEFAULT(current, rhs, n) ((current) = language_span(&YYRHSLOC(rhs, (n) ? 1 : 0), &YYRHSLOC(rhs, n)))
#define YYSTACK_USE_ALLOCA 0
#define YYMALLOC(size) memory_alloc(1, size)
#define YYFREE memory_free

/* In the action of an `error` item: the parser goes on with the token tokens_recover stops at. */
#define RECOVER() \
  do { \
    yyerrok; \
    yyclearin; \
    if (!tokens_recover(language)) YYABORT; \
  } while (0)

static int pscn_lex(PSCN_STYPE *value, PSCN_LTYPE *place, struct language *language)
{
  const int token = tokens_next(language, &value->token);
  *place = value->token.place;
  return token;
}

/* Told by the parser only when its stack is full. */
static void pscn_error(PSCN_LTYPE *place, struct language *language, const char *message)
{
  (void)message;
  language_limit(language, *place, "this is nested too deeply");
}
}

%union {
  struct token token;
  struct value value;
  struct texture *texture;
  struct node *node;
  struct declaration *declaration;
  struct matrix *matrix;
  const struct transform *transform;
}

%token END 0 "the end of the text"
%token <token> NUMBER "a number" POINT "a vector" WORD "a name" STRING "a string"
%token FOREIGN "a word of POV-Ray's" START_SCENE START_SOLVER
%token VERSION "#version" DECLARE "#declare" LOCAL "#local" DEFAULT "#default"
%token GLOBAL_SETTINGS "global_settings" ASSUMED_GAMMA "assumed_gamma" MAX_TRACE_LEVEL "max_trace_level"
%token AMBIENT_LIGHT "ambient_light"
%token CAMERA "camera" PERSPECTIVE "perspective" LOCATION "location" DIRECTION "direction" RIGHT "right" UP "up"
%token SKY "sky" ANGLE "angle" LOOK_AT "look_at"
%token LIGHT_SOURCE "light_source" SHADOWLESS "shadowless" BACKGROUND "background"
%token BICUBIC_PATCH "bicubic_patch" TYPE "type" FLATNESS "flatness" U_STEPS "u_steps" V_STEPS "v_steps"
%token UNION "union" OBJECT "object" TRANSLATE "translate" ROTATE "rotate" SCALE "scale" MATRIX "matrix"
%token TEXTURE "texture" PIGMENT "pigment" FINISH "finish"
%token AMBIENT "ambient" DIFFUSE "diffuse" BRILLIANCE "brilliance" PHONG "phong" PHONG_SIZE "phong_size"
%token SPECULAR "specular" ROUGHNESS "roughness"
%token COLOR "color" RGB "rgb" X "x" Y "y" Z "z" RED "red" GREEN "green" BLUE "blue" PI "pi"
%token IMAGE_WIDTH "image_width" IMAGE_HEIGHT "image_height" VERSION_WORD "version"
%token DEPRECATED "deprecated" ONCE "once" /* before a name whose use POV-Ray warns of */
%token RGBF "rgbf" RGBFT "rgbft" FILTER "filter"
%token SOLVER "solver"

%type <value> expression colour quantity four five
%type <token> component part
%type <texture> texture_block pigment_block finish_block surface
%type <node> object patch union copy
%type <declaration> declare
%type <matrix> matrix_numbers
%type <transform> transform

/* A declaration that an error ends: its name is not unknown as well. */
%destructor { declare_broken(language, $$); } <declaration>

/* Where an expression may be followed by the next item, "+" and "-" belong to the expression, as in POV-Ray. */
%precedence ITEM
%precedence ','
%precedence TEXTURE
%left '+' '-'
%left '*' '/'
%precedence SIGN
%precedence '.'

%%

input: START_SCENE statements | START_SOLVER solver;

statements: %empty | statements statement;
statement:
    VERSION expression ';'                     { language_version(language, &$2); }
  | DEFAULT '{' default_items '}'
  | declaration
  | GLOBAL_SETTINGS '{' global_items '}'
  | CAMERA '{' { camera_begin(language, @1); } camera_items '}' { camera_end(language); }
  | LIGHT_SOURCE '{' { light_begin(language, @1); } light_items '}' { light_end(language); }
  | BACKGROUND '{' { background_begin(language, @1); } background_items '}' { background_end(language); }
  | object                                     { scene_add(language, @1, $1); }
  | solver                                     { solver_misplaced(language, @1); }
  | error                                      { RECOVER(); }
  ;

default_items: %empty | default_items default_item;
default_item:
    surface                                    { texture_set_default(language, $1); }
  | declaration
  | error                                      { RECOVER(); }
  ;

declaration:
    declare colour ';'                         { declare_value(language, $1, &$2); }
  | declare object                             { declare_object(language, $1, $2); } semicolon
  | declare surface                            { declare_texture(language, $1, $2); } layers semicolon
  ;
layers: %empty | layers TEXTURE '{' { layer_begin(language, @2); } texture_items '}' { layer_end(language); };
declare: DECLARE old WORD '='                  { $$ = declare_begin(language, &$3, false); }
  | LOCAL old WORD '='                         { $$ = declare_begin(language, &$3, true); };
old: %empty | DEPRECATED STRING | DEPRECATED ONCE STRING;
semicolon: %empty %prec ITEM | ';';

/* ---- values ---- */

expression:
    NUMBER                                     { $$ = value_of_number($1.number[0], @1); }
  | POINT                                      { $$ = value_of_vector($1.number, @1); }
  | WORD                                       { $$ = value_named(language, &$1); }
  | X                                          { $$ = value_axis(0, @1); }
  | Y                                          { $$ = value_axis(1, @1); }
  | Z                                          { $$ = value_axis(2, @1); }
  | PI                                         { $$ = value_of_number(3.14159265358979323846, @1); }
  | IMAGE_WIDTH                                { $$ = value_of_number(language->width, @1); }
  | IMAGE_HEIGHT                               { $$ = value_of_number(language->height, @1); }
  | VERSION_WORD                               { $$ = value_of_number(language->settings->version, @1); }
  | '(' expression ')'                         { $$ = value_placed($2, @$); }
  | '<' expression comma expression comma expression '>'
                                               { $$ = value_of_parts(language, &$2, &$4, &$6, @$); }
  | '<' expression comma expression '>'        { $$ = value_flat(language, @$); }
  | expression '+' expression                  { $$ = value_binary(language, '+', &$1, &$3); }
  | expression '-' expression                  { $$ = value_binary(language, '-', &$1, &$3); }
  | expression '*' expression                  { $$ = value_binary(language, '*', &$1, &$3); }
  | expression '/' expression                  { $$ = value_binary(language, '/', &$1, &$3); }
  | '-' expression %prec SIGN                  { $$ = value_negative(language, &$2, @$); }
  | '+' expression %prec SIGN                  { $$ = value_placed($2, @$); }
  | expression '.' component                   { $$ = value_component(language, &$1, $3.index, @$); }
  ;

component: X { $$.index = 0; } | Y { $$.index = 1; } | Z { $$.index = 2; }
  | RED { $$.index = 0; } | GREEN { $$.index = 1; } | BLUE { $$.index = 2; };

comma: %empty %prec ITEM | ',';

/* A plain vector or number is a colour wherever POV-Ray takes it for one. */
colour:
    expression %prec ITEM
  | RGB expression %prec ITEM                  { $$ = value_rgb(language, &$2, @$); }
  | RGBF expression %prec ITEM                 { $$ = value_rgbft(language, &$2, 4, @$); }
  | RGBFT expression %prec ITEM                { $$ = value_rgbft(language, &$2, 5, @$); }
  | RGBF four                                  { $$ = value_placed($2, @$); }
  | RGBFT five                                 { $$ = value_placed($2, @$); }
  | COLOR expression %prec ITEM                { $$ = value_color(language, &$2, @$); }
  | COLOR RGB expression %prec ITEM            { $$ = value_rgb(language, &$3, @$); }
  | COLOR RGBF expression %prec ITEM           { $$ = value_rgbft(language, &$3, 4, @$); }
  | COLOR RGBFT expression %prec ITEM          { $$ = value_rgbft(language, &$3, 5, @$); }
  | COLOR RGBF four                            { $$ = value_placed($3, @$); }
  | COLOR RGBFT five                           { $$ = value_placed($3, @$); }
  | COLOR part expression %prec ITEM           { $$ = value_part(language, NULL, $2.index, &$3, @$); }
  | colour part expression %prec ITEM          { $$ = value_part(language, &$1, $2.index, &$3, @$); }
  ;
part: RED { $$.index = 0; } | GREEN { $$.index = 1; } | BLUE { $$.index = 2; } | FILTER { $$.index = 3; };
four: '<' expression comma expression comma expression comma expression '>'
                                               { $$ = value_wide(language, &$2, &$4, &$6, &$8, NULL, @$); };
five: '<' expression comma expression comma expression comma expression comma expression '>'
                                               { $$ = value_wide(language, &$2, &$4, &$6, &$8, &$10, @$); };

/* ---- settings, camera, lights ---- */

global_items: %empty | global_items global_item;
global_item:
    ASSUMED_GAMMA expression                   { global_gamma(language, &$2); }
  | MAX_TRACE_LEVEL expression                 { global_trace_level(language, &$2); }
  | AMBIENT_LIGHT colour                       { global_ambient(language, &$2); }
  | solver                                     { global_solver(language); }
  | declaration
  | error                                      { RECOVER(); }
  ;

camera_items: %empty | camera_items camera_item;
camera_item:
    PERSPECTIVE                                { camera_perspective(language, @1); }
  | LOCATION expression                        { camera_vector(language, CAMERA_LOCATION, &$2); }
  | DIRECTION expression                       { camera_vector(language, CAMERA_DIRECTION, &$2); }
  | RIGHT expression                           { camera_vector(language, CAMERA_RIGHT, &$2); }
  | UP expression                              { camera_vector(language, CAMERA_UP, &$2); }
  | SKY expression                             { camera_vector(language, CAMERA_SKY, &$2); }
  | LOOK_AT expression                         { camera_vector(language, CAMERA_LOOK_AT, &$2); }
  | ANGLE expression                           { camera_angle(language, &$2); }
  | transform                                  { camera_transform(language, $1); }
  | declaration
  | error                                      { RECOVER(); }
  ;

/* The position, then the colour, then the rest. */
light_items: %empty | light_items light_item;
light_item:
    colour %prec ITEM                          { light_value(language, &$1); }
  | ','                                        { light_comma(language, @1); }
  | SHADOWLESS                                 { light_shadowless(language, @1); }
  | transform                                  { light_transform(language, $1, @1); }
  | declaration
  | error                                      { RECOVER(); }
  ;

background_items: %empty | background_items background_item;
background_item:
    colour %prec ITEM                          { background_value(language, &$1); }
  | declaration
  | error                                      { RECOVER(); }
  ;

/* ---- objects ---- */

object: patch | union | copy;

/* Settings, then 16 points, then modifiers. */
patch: BICUBIC_PATCH '{' { patch_begin(language, @1); } patch_items '}'
    { patch_end(language); $$ = node_end(language); };
patch_items: %empty | patch_items patch_item
  | patch_items expression ','                 { patch_point(language, &$2), patch_comma(language, @3); }
  | patch_items expression %prec ITEM          { patch_point(language, &$2); }
  ;
patch_item:
    TYPE expression %prec ITEM                 { patch_number(language, PATCH_TYPE, @1, &$2); }
  | FLATNESS expression %prec ITEM             { patch_number(language, PATCH_FLATNESS, @1, &$2); }
  | U_STEPS expression %prec ITEM              { patch_number(language, PATCH_U_STEPS, @1, &$2); }
  | V_STEPS expression %prec ITEM              { patch_number(language, PATCH_V_STEPS, @1, &$2); }
  | ','                                        { patch_comma(language, @1); }
  | modifier                                   { patch_modified(language); }
  | solver                                     { patch_solver(language); }
  | declaration
  | error                                      { RECOVER(); }
  ;

/* The objects, then modifiers. */
union: UNION '{' { union_begin(language, @1); } union_items '}' { $$ = node_end(language); };
union_items: %empty | union_items union_item;
union_item:
    object                                     { union_add(language, @1, $1); }
  | modifier                                   { union_modified(language); }
  | solver                                     { solver_misplaced(language, @1); }
  | declaration
  | error                                      { RECOVER(); }
  ;

/* The object, then modifiers. */
copy: OBJECT '{' { copy_begin(language, @1); } copy_items '}' { copy_end(language); $$ = node_end(language); };
copy_items: %empty | copy_items copy_item;
copy_item:
    WORD                                       { copy_named(language, &$1); }
  | object                                     { copy_object(language, @1, $1); }
  | modifier                                   { copy_modified(language, @1); }
  | solver                                     { solver_misplaced(language, @1); }
  | declaration
  | error                                      { RECOVER(); }
  ;

modifier:
    transform                                  { node_transform(language, $1, @1); }
  | surface                                    { node_texture(language, $1); }
  ;

transform:
    TRANSLATE expression %prec ITEM            { $$ = transform_translate(language, &$2); }
  | ROTATE expression %prec ITEM               { $$ = transform_rotate(language, &$2); }
  | SCALE expression %prec ITEM                { $$ = transform_scale(language, &$2); }
  | MATRIX '<' matrix_numbers '>'              { $$ = transform_matrix(language, $3, @$); }
  | MATRIX POINT                               { $$ = transform_matrix(language, NULL, @2); }
  ;
matrix_numbers:
    expression %prec ITEM                      { $$ = matrix_begin(language, &$1); }
  | matrix_numbers comma expression %prec ITEM { matrix_add(language, $$ = $1, &$3); }
  ;

/* ---- textures ---- */

surface: texture_block | pigment_block | finish_block;

texture_block: TEXTURE '{' { texture_begin(language, TEXTURE_ALL); } texture_items '}' { $$ = texture_end(language); };
texture_items: %empty | texture_items texture_item;
texture_item:
    WORD                                       { texture_named(language, &$1); }
  | pigment_block                              { texture_merge(language, $1); }
  | finish_block                               { texture_merge(language, $1); }
  | transform                                  { texture_moved(language); }
  | declaration
  | error                                      { RECOVER(); }
  ;

pigment_block: PIGMENT '{' { texture_begin(language, TEXTURE_PIGMENT); } pigment_items '}'
    { $$ = texture_end(language); };
pigment_items: %empty | pigment_items pigment_item;
pigment_item:
    colour %prec ITEM                          { pigment_value(language, &$1); }
  | transform                                  { texture_moved(language); }
  | declaration
  | error                                      { RECOVER(); }
  ;

finish_block: FINISH '{' { texture_begin(language, TEXTURE_FINISH); } finish_items '}' { $$ = texture_end(language); };
finish_items: %empty | finish_items finish_item;
finish_item:
    WORD                                       { texture_named(language, &$1); }
  | AMBIENT colour                             { finish_ambient(language, &$2); }
  | DIFFUSE expression                         { finish_number(language, PART_DIFFUSE, &$2); }
  | BRILLIANCE expression                      { finish_number(language, PART_BRILLIANCE, &$2); }
  | PHONG expression                           { finish_number(language, PART_PHONG, &$2); }
  | PHONG_SIZE expression                      { finish_number(language, PART_PHONG_SIZE, &$2); }
  | SPECULAR expression                        { finish_number(language, PART_SPECULAR, &$2); }
  | ROUGHNESS expression                       { finish_number(language, PART_ROUGHNESS, &$2); }
  | declaration
  | error                                      { RECOVER(); }
  ;

/* ---- solvers: all words are plain here ---- */

solver: SOLVER WORD                            { solver_begin(language, &$2); } solver_block;
solver_block: %empty | '{' solver_items '}';
solver_items: %empty | solver_items solver_item;
solver_item:
    WORD quantity                              { solver_quantity(language, &$1, &$2); }
  | WORD WORD                                  { solver_word(language, &$1, &$2); }
  | error                                      { RECOVER(); }
  ;

/* A name may be a word of the item's; within an expression it stands in parentheses. */
quantity:
    NUMBER                                     { $$ = value_of_number($1.number[0], @1); }
  | '(' expression ')'                         { $$ = value_placed($2, @$); }
  | quantity '+' quantity                      { $$ = value_binary(language, '+', &$1, &$3); }
  | quantity '-' quantity                      { $$ = value_binary(language, '-', &$1, &$3); }
  | quantity '*' quantity                      { $$ = value_binary(language, '*', &$1, &$3); }
  | quantity '/' quantity                      { $$ = value_binary(language, '/', &$1, &$3); }
  | '-' quantity %prec SIGN                    { $$ = value_negative(language, &$2, @$); }
  | '+' quantity %prec SIGN                    { $$ = value_placed($2, @$); }
  ;

%%

static int yyreport_syntax_error(const yypcontext_t *context, struct language *language)
{
  enum { MOST = 128 };
  yysymbol_kind_t kinds[MOST];
  const char *names[MOST];
  const int count = yypcontext_expected_tokens(context, kinds, MOST);
  for (int k = 0; k < count; k++) names[k] = yysymbol_name(kinds[k]);
  syntax_error(language, *yypcontext_location(context), yypcontext_token(context) == YYSYMBOL_WORD, names,
               count > 0 ? count : 0);
  return 0;
}
