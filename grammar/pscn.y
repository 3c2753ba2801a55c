/* The grammar of the language. Each action is one call; what things mean is in src/language. */
%require "3.8"
%define api.pure full
%define api.prefix {pscn_}
%define api.token.prefix {PSCN_TOKEN_}
%define api.location.type {struct place}
%define parse.error custom
%define parse.lac full
%locations
%param {struct language *language}

%code requires {
#include "language/build.h"
}

%code {
#include "language/tokens.h"

#define YYLLOC_DEFAULT(current, rhs, n) ((current) = language_span(&YYRHSLOC(rhs, (n) ? 1 : 0), &YYRHSLOC(rhs, n)))

static int pscn_lex(PSCN_STYPE *value, PSCN_LTYPE *place, struct language *language)
{
  return tokens_next(language, &value->token, place);
}

static void pscn_error(PSCN_LTYPE *place, struct language *language, const char *message)
{
  (void)message; /* bison calls this for nothing but its stack, whose size is bounded */
  language_error(language, *place, "expressions or blocks are nested too deep here");
}
}

%union {
  struct token token;
  struct value value;
  struct transform transform;
  struct texture texture;
  struct node *node;
}

%token END 0 "the end of the file"
%token <token> NUMBER "a number" POINT "a vector" WORD "a name" STRING "a file name in quotes"
%token VERSION "#version" DECLARE "#declare" LOCAL "#local"
%token GLOBAL_SETTINGS "global_settings" ASSUMED_GAMMA "assumed_gamma" MAX_TRACE_LEVEL "max_trace_level" AMBIENT_LIGHT "ambient_light"
%token CAMERA "camera" PERSPECTIVE "perspective" LOCATION "location" DIRECTION "direction" RIGHT "right" UP "up" SKY "sky"
%token ANGLE "angle" LOOK_AT "look_at"
%token LIGHT_SOURCE "light_source" SHADOWLESS "shadowless" BACKGROUND "background"
%token BICUBIC_PATCH "bicubic_patch" TYPE "type" FLATNESS "flatness" U_STEPS "u_steps" V_STEPS "v_steps"
%token UNION "union" OBJECT "object" TRANSLATE "translate" ROTATE "rotate" SCALE "scale" MATRIX "matrix"
%token TEXTURE "texture" PIGMENT "pigment" FINISH "finish"
%token AMBIENT "ambient" DIFFUSE "diffuse" BRILLIANCE "brilliance" PHONG "phong" PHONG_SIZE "phong_size"
%token SPECULAR "specular" ROUGHNESS "roughness"
%token COLOR "color" RGB "rgb" X "x" Y "y" Z "z" RED "red" GREEN "green" BLUE "blue" PI "pi"
%token IMAGE_WIDTH "image_width" IMAGE_HEIGHT "image_height"
%token SOLVER "solver"

%type <value> expression vector_literal colour
%type <token> component declare
%type <transform> transform
%type <texture> texture_block pigment_block finish_block texture_like texture_items
%type <node> object patch union named

%precedence NO_COMMA
%precedence COLOR RGB
%left '+' '-'
%left '*' '/'
%precedence SIGN
%precedence '.'

%%

file: %empty | file statement;

statement:
    VERSION expression ';'                     { language_version(language, @2, &$2); }
  | declaration
  | GLOBAL_SETTINGS '{' global_items '}'
  | CAMERA '{' { camera_begin(language, @1); } camera_items '}' { camera_end(language, @1); }
  | LIGHT_SOURCE '{' expression comma colour   { light_begin(language, @3, &$3, @5, &$5); } light_items '}'
  | BACKGROUND '{' colour '}'                  { background_set(language, @3, &$3); }
  | object                                     { scene_add(language, @1, $1); }
  | solver                                     { solver_statement(language, @1); }
  | ';'
  | error                                      { language_resume(language); }
  ;

declare: DECLARE WORD '=' { $$ = $2; $$.local = false; } | LOCAL WORD '=' { $$ = $2; $$.local = true; };

declaration:
    declare expression ';'                     { declare_value(language, @1, &$1, &$2); }
  | declare object                             { declare_object(language, @1, &$1, $2); }
  | declare texture_like                       { declare_texture(language, @1, &$1, &$2); }
  | declare error ';'
  ;

comma: %empty %prec NO_COMMA | ',';

/* ---- values ---- */

expression:
    NUMBER                                     { $$ = value_of_number($1.number[0]); }
  | POINT                                      { $$ = value_of_vector($1.number); }
  | vector_literal
  | WORD                                       { $$ = value_named(language, @1, &$1); }
  | X                                          { $$ = value_axis(0); }
  | Y                                          { $$ = value_axis(1); }
  | Z                                          { $$ = value_axis(2); }
  | PI                                         { $$ = value_pi(); }
  | IMAGE_WIDTH                                { $$ = value_of_number(language->width); }
  | IMAGE_HEIGHT                               { $$ = value_of_number(language->height); }
  | '(' expression ')'                         { $$ = $2; }
  | expression '+' expression                  { $$ = value_binary(language, @$, '+', &$1, &$3); }
  | expression '-' expression                  { $$ = value_binary(language, @$, '-', &$1, &$3); }
  | expression '*' expression                  { $$ = value_binary(language, @$, '*', &$1, &$3); }
  | expression '/' expression                  { $$ = value_binary(language, @$, '/', &$1, &$3); }
  | '-' expression %prec SIGN                  { $$ = value_negative(&$2); }
  | '+' expression %prec SIGN                  { $$ = $2; }
  | expression '.' component                   { $$ = value_component(language, @1, &$1, $3.index); }
  | RGB expression                             { $$ = value_rgb(&$2); }
  | COLOR expression                           { $$ = value_rgb(&$2); }
  ;

component: X { $$.index = 0; } | Y { $$.index = 1; } | Z { $$.index = 2; }
  | RED { $$.index = 0; } | GREEN { $$.index = 1; } | BLUE { $$.index = 2; };

vector_literal: '<' expression ',' expression ',' expression '>' { $$ = value_vector3(language, @$, &$2, &$4, &$6); };

colour: expression;

/* ---- settings, camera, lights ---- */

global_items: %empty | global_items global_item;
global_item:
    ASSUMED_GAMMA expression                   { global_gamma(language, @2, &$2); }
  | MAX_TRACE_LEVEL expression                 { global_trace_level(language, @2, &$2); }
  | AMBIENT_LIGHT colour                       { global_ambient(language, @2, &$2); }
  | solver                                     { global_solver(language); }
  | error
  ;

camera_items: %empty | camera_items camera_item;
camera_item:
    PERSPECTIVE
  | LOCATION expression                        { camera_vector(language, CAMERA_LOCATION, @2, &$2); }
  | DIRECTION expression                       { camera_vector(language, CAMERA_DIRECTION, @2, &$2); }
  | RIGHT expression                           { camera_vector(language, CAMERA_RIGHT, @2, &$2); }
  | UP expression                              { camera_vector(language, CAMERA_UP, @2, &$2); }
  | SKY expression                             { camera_vector(language, CAMERA_SKY, @2, &$2); }
  | LOOK_AT expression                         { camera_vector(language, CAMERA_LOOK_AT, @2, &$2); }
  | ANGLE expression                           { camera_angle(language, @2, &$2); }
  | error
  ;

light_items: %empty | light_items light_item;
light_item:
    SHADOWLESS                                 { light_shadowless(language); }
  | transform                                  { light_transform(language, @1, &$1); }
  | error
  ;

/* ---- objects ---- */

object: patch | union | named;

patch: BICUBIC_PATCH '{' { patch_begin(language, @1); } patch_heads points { patch_points_end(language, @1); } modifiers '}'
                                               { $$ = node_end(language); };
patch_heads: patch_head comma | patch_heads patch_head comma;
patch_head:
    TYPE expression %prec NO_COMMA { patch_number(language, PATCH_TYPE, @2, &$2); }
  | FLATNESS expression %prec NO_COMMA { patch_number(language, PATCH_FLATNESS, @2, &$2); }
  | U_STEPS expression %prec NO_COMMA { patch_number(language, PATCH_U_STEPS, @2, &$2); }
  | V_STEPS expression %prec NO_COMMA { patch_number(language, PATCH_V_STEPS, @2, &$2); }
  | error
  ;
points: point | points comma point;
point: expression %prec NO_COMMA               { patch_point(language, @1, &$1); };

union: UNION '{' { union_begin(language, @1); } union_items '}' { $$ = node_end(language); };
union_items: %empty | union_items union_item;
union_item: object { union_add(language, @1, $1); } | modifier;

named: OBJECT '{' named_head modifiers '}'     { $$ = node_end(language); };
named_head: WORD { named_begin(language, @1, &$1); } | object { wrapped_begin(language, @1, $1); };

modifiers: %empty | modifiers modifier;
modifier:
    transform                                  { node_transform(language, @1, &$1); }
  | texture_like                               { node_texture(language, &$1); }
  | solver                                     { node_solver(language, @1); }
  | error
  ;

transform:
    TRANSLATE expression                       { $$ = transform_translate(language, @2, &$2); }
  | ROTATE expression                          { $$ = transform_rotate(language, @2, &$2); }
  | SCALE expression                           { $$ = transform_scale(language, @2, &$2); }
  | MATRIX '<' { matrix_begin(language); } matrix_numbers '>' { $$ = matrix_end(language, @$); }
  ;
matrix_numbers: matrix_number | matrix_numbers ',' matrix_number;
matrix_number: expression                      { matrix_add(language, @1, &$1); };

/* ---- textures ---- */

texture_like: texture_block | pigment_block | finish_block;

texture_block: TEXTURE '{' { texture_begin(language, TEXTURE_ALL); } texture_items '}' { $$ = texture_end(language); };
texture_items: %empty {} | texture_items texture_item {};
texture_item:
    WORD                                       { texture_named(language, @1, &$1); }
  | pigment_block                              { texture_merge(language, &$1); }
  | finish_block                               { texture_merge(language, &$1); }
  | transform                                  { texture_transform(language, &$1); }
  | error
  ;

pigment_block: PIGMENT '{' { texture_begin(language, TEXTURE_PIGMENT); } pigment_items '}' { $$ = texture_end(language); };
pigment_items: %empty | pigment_items pigment_item;
pigment_item:
    WORD                                       { pigment_named(language, @1, &$1); }
  | RGB expression                             { pigment_colour(language, @2, &$2); }
  | COLOR expression                           { pigment_colour(language, @2, &$2); }
  | transform                                  { texture_transform(language, &$1); }
  | error
  ;

finish_block: FINISH '{' { texture_begin(language, TEXTURE_FINISH); } finish_items '}' { $$ = texture_end(language); };
finish_items: %empty | finish_items finish_item;
finish_item:
    WORD                                       { texture_named(language, @1, &$1); }
  | AMBIENT colour                             { finish_ambient(language, @2, &$2); }
  | DIFFUSE expression                         { finish_number(language, FINISH_DIFFUSE, @2, &$2); }
  | BRILLIANCE expression                      { finish_number(language, FINISH_BRILLIANCE, @2, &$2); }
  | PHONG expression                           { finish_number(language, FINISH_PHONG, @2, &$2); }
  | PHONG_SIZE expression                      { finish_number(language, FINISH_PHONG_SIZE, @2, &$2); }
  | SPECULAR expression                        { finish_number(language, FINISH_SPECULAR, @2, &$2); }
  | ROUGHNESS expression                       { finish_number(language, FINISH_ROUGHNESS, @2, &$2); }
  | error
  ;

/* ---- solvers ---- */

solver: SOLVER WORD                            { solver_begin(language, @2, &$2); } solver_block;
solver_block: %empty | '{' solver_items '}';
solver_items: %empty | solver_items solver_item;
solver_item:
    WORD NUMBER                                { solver_number(language, @1, &$1, @2, $2.number[0]); }
  | WORD '-' NUMBER                            { solver_number(language, @1, &$1, @3, -$3.number[0]); }
  | WORD '+' NUMBER                            { solver_number(language, @1, &$1, @3, $3.number[0]); }
  | WORD WORD                                  { solver_word(language, @1, &$1, @2, &$2); }
  | error
  ;

%%

static int yyreport_syntax_error(const yypcontext_t *context, struct language *language)
{
  enum { MOST = 64 };
  yysymbol_kind_t kinds[MOST];
  const char *names[MOST];
  const int count = yypcontext_expected_tokens(context, kinds, MOST);
  for (int k = 0; k < count; k++) names[k] = yysymbol_name(kinds[k]);
  const yysymbol_kind_t found = yypcontext_token(context);
  language_unexpected(language, *yypcontext_location(context), found == YYSYMBOL_YYEMPTY ? NULL : yysymbol_name(found),
                      found == YYSYMBOL_WORD, names, count > 0 ? count : 0);
  return 0;
}
