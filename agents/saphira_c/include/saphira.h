/* The C library of the Saphira manual 5.3, for C and C++. The number behind a name is the section of
 * the manual. docs/c-api.md says where something differs, and why.
 *
 * Millimetres and degrees where the manual has them; angles of points are radians. All that a
 * micro-task sees of the robot is refreshed at the start of each cycle and stays as it is until the
 * next. Another thread sees the newest whole cycle: each access looks anew. */
#ifndef SAPHIRA_H
#define SAPHIRA_H

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#define SF_OPTIONAL_ARGUMENT int unused = 0
#else
#define SF_OPTIONAL_ARGUMENT
#endif
#if defined(__GNUC__)
#define SF_LIKE_PRINTF __attribute__((format(printf, 1, 2)))
#else
#define SF_LIKE_PRINTF
#endif

#define IMPORT
#ifndef TRUE
#define TRUE 1
#define FALSE 0
#endif
#ifndef True
#define True 1
#define False 0
#endif
typedef int boolean;

/* ---- 6.1: the OS. */

void sfStartup(int async);
void sfPause(int ms);
void sfOnStartupFn(void (*fn)(void));
void sfOnConnectFn(void (*fn)(void));
void sfOnDisconnectFn(void (*fn)(void));
#define sfIsConnected (sf_is_connected())
int sf_is_connected(void);

/* Display modes, Table 6-1. */
enum { sfDISPLAY, sfGLOBAL, sfWAKE, sfSTEP, sfOCCGRID };
void sfSetDisplayState(int menu, int state);

void sfMessage(const char* str);
void sfSMessage(const char* str, ...) SF_LIKE_PRINTF;
void sfErrMessage(const char* str);
void sfErrSMessage(const char* str, ...) SF_LIKE_PRINTF;

#define SPACEKEY ' '
enum { sfButtonLeft = 1, sfButtonMiddle, sfButtonRight };
void sfKeyProcFn(int (*fn)(int ch));
#define sfProcessKey sfKeyProcFn /* 2.3.5 */
void sfButtonProcFn(int (*fn)(int x, int y, int b));
float sfScreenToWorldX(int x, int y);
float sfScreenToWorldY(int x, int y);

/* ---- 6.3: state reflection. */

enum { STATUS_NOT_CONNECTED, STATUS_STOPPED, STATUS_MOVING, STATUS_NO_HIGH_POWER };
struct robot {
  float x, y, th;       /* always 0 [mm, radians] */
  float ax, ay, ath;    /* global location [mm, radians] */
  float tv, mtv;        /* current and maximal velocity [mm/s] */
  float rv, mrv;        /* current and maximal rotational velocity [deg/s] */
  float leftv, rightv;  /* wheel velocities [mm/s] */
  int status;
  int battery; /* [1/10 V] */
  int bumpers;
  int ptu; /* [usec] */
  int diginput, digoutput;
  int analog;
  int motor_packet_count, sonar_packet_count, vision_packet_count; /* [1/s] */
};
#define sfRobot (*sf_robot())
struct robot* sf_robot(void);

enum { sfLEFT, sfRIGHT, sfFRONT, sfBACK, sfSIDES, sfALL };
int sfStalledMotor(int which); /* 6.3.1 */

typedef struct {
  float fx, fy, fth;    /* robot position when the sonar was read */
  float afx, afy, afth; /* its global position */
  float x, y;           /* on the sonar's axis at its range, in robot coordinates of now */
  int range;            /* [mm] 5000: no echo */
  int snew;             /* 0xFFFF: a new reading */
} sdata;                /* 6.3.2 */
#define SF_MAX_SONARS 32
#define sbucket (sf_sbucket())
sdata* sf_sbucket(void);
int sfSonarRange(int num);
float sfSonarXCoord(int num);
float sfSonarYCoord(int num);
int sfSonarNew(int num);

/* ---- 6.4: direct motion control. */

void sfSetVelocity(int vel);     /* [mm/s] */
void sfSetRVelocity(int rvel);   /* [deg/s] */
void sfSetHeading(int head);     /* [deg] */
void sfSetDHeading(int dhead);   /* [deg] */
void sfSetPosition(int dist);    /* [mm] */
void sfSetMaxVelocity(int vel);  /* [mm/s] */
/* Ends whatever moves the robot: this program, others, people, goals. After a stop by anybody the
 * motion commands of this program have no effect until sfSetVelocity(0), with no turn. */
void sfStopRobot(void);
int sfDonePosition(int dist);    /* [mm] */
int sfDoneHeading(int ang);      /* [deg] */
float sfTargetVel(void);         /* [mm/s] */
float sfTargetHead(void);        /* [deg] */

/* ---- 7.6: the parts of behaviors. */

typedef union beh_param {
  float f;
  int i;
  void* p;
} beh_param;
typedef beh_param* beh_params;
beh_params beh_alloc(int n); /* 8.1.2; freed with the intention that gets it */

typedef struct {
  const char* name;
  int antecedent;  /* index into beh_state */
  int* consequent; /* &Accel, &Decel, &Turn_left or &Turn_right: declare them as extern int */
  int mean;        /* index into beh_state: [mm/s] of Accel and Decel, [deg] of turns */
} beh_rule;
typedef struct {
  const char* name;
  void (*init)(beh_params);
  void (*update)(beh_params);
  int n_params;
  int n_rules; /* 10 at the most */
  beh_rule rules[10];
} behavior;
/* The fuzzy state of the behavior whose init or update function is running. */
#define BEH_STATE_LEN 64
extern float* beh_state;
/* The activity of the behavior, set by update: the weights of its turn and of its speed, the
 * satisfaction of its goal, and its progress. Before each update 1, 1, 0, 0. */
extern float c_act_t, c_act_v, c_goal, c_progress;

typedef struct beh_closure {
  const char* name;
  behavior* beh;
  int priority;
  int running;
  beh_params params;
  float goal, act_t, act_v; /* as of the newest cycle */
}* BEHCLOSURE;

/* ---- 6.5: micro-tasks, and 8: intentions. */

typedef struct process {
  const char* name;
  int state;
  struct process* dad;  /* of an intention: the one that made it; else NULL */
  beh_params params;    /* of an intention */
  int timeout;          /* of an intention [cycles]; 0: none */
  void (*fn)(void);
  BEHCLOSURE beh;       /* of intend_beh */
} process;

enum {
  sfINIT = 0, sfSUSPEND = 1, sfRESUME = 2, sfINTERRUPT = 3, sfREMOVE = 4,
  sfSUCCESS = 5, sfFAILURE = 6, sfTIMEOUT = 7
};
#define INIT sfINIT
#define SUSPEND sfSUSPEND
#define RESUME sfRESUME
#define INTERRUPT sfINTERRUPT
#define REMOVE sfREMOVE
#define SUCCESS sfSUCCESS
#define FAILURE sfFAILURE
#define TIMEOUT sfTIMEOUT
extern int process_state;

process* sfInitProcess(void (*fn)(void), const char* name);
process* sfFindProcess(const char* name);
void sfSetProcessState(process* p, int state);
void sfSuspendProcess(process* p, int n);
void sfSuspendSelf(int n);
void sfInterruptProcess(process* p);
void sfInterruptSelf(void);
void sfResumeProcess(process* p);

void sfInitBasicProcs(void); /* 6.2 */
void sfInitControlProcs(void);
void sfInitInterpretationProcs(void);
void sfInitRegistrationProcs(void);
void sfInitSpecialProcs(void); /* 4.3.4 */
void sfInitAwareProcs(void);   /* 4.3.4 */
/* Their processes, for sfInitProcess one by one. */
void pulse_proc(void), motor_proc(void), clamp_proc(void), sonar_proc(void), wake_proc(void),
    draw_proc(void), process_waiting_packets(void), execute_current_behaviors(void),
    occgrid_proc(void), side_segment_proc(void), test_wall_proc(void), test_wall_break_proc(void),
    test_match_proc(void), test_environment_proc(void);

process* sfInitIntention(void (*fn)(void), const char* name, int timeout, ...); /* 8.3 */
int finished(process* p);                                                       /* 8.4 */
process* intend_beh(behavior* b, const char* name, int timeout, beh_params params,
                    int priority); /* 8.5 */
#define sf_intention_self (sf_self())
process* sf_self(void);    /* the process or intention that runs now; NULL outside of one */
void sfFindAndFollow(void); /* 8.1 */
/* 8.1: the parameters of a lane follower. */
#define FOL_LANE(params) ((params)[0].p)
#define FOL_TARGET(params) ((params)[1].p)

/* ---- 6.6: the Local Perceptual Space. */

#define CBUF_LEN 200
typedef struct {
  int start, end;
  int limit;
  float xbuf[CBUF_LEN];
  float ybuf[CBUF_LEN];
  int valid[CBUF_LEN];
} cbuf;
#define sraw_buf (sf_sonar_buffer(sfFRONT))
#define sl_buf (sf_sonar_buffer(sfLEFT))
#define sr_buf (sf_sonar_buffer(sfRIGHT))
cbuf* sf_sonar_buffer(int which);
void sfSetFrontBuffer(int n);
void sfSetSideBuffer(int n);
extern float sfFrontMaxRange; /* [mm] */

/* 6.6.2. Its examples have one argument more, which has no effect. */
int sfOccBox(int xy, int cx, int cy, int h, int w, ...);
int sfOccBoxRet(int xy, int cx, int cy, int h, int w, int* x, int* y);
int sfOccPlane(int xy, int source, int d, int s1, int s2);
int sfOccPlaneRet(int xy, int source, int d, int s1, int s2, int* x, int* y);

typedef enum { SYSTEM, PERCEPT, ARTIFACT } cat_type; /* 6.6.3.1 */
typedef enum {
  INVALID, POS, WALL, CORRIDOR, LANE, DOOR, JUNCTION, OFFICE, BREAK, OBJECT, ZONE
} pt_type;
#define SF_POINT                                                        \
  float x, y, th; /* relative to the robot [mm, radians] */             \
  pt_type type;                                                         \
  cat_type cat;                                                         \
  boolean snew;     /* just found */                                    \
  boolean viewable; /* valid, and drawn */                              \
  int id;                                                               \
  float ax, ay, ath;      /* global coordinates */                      \
  unsigned int matched;   /* cycle of the last match */                 \
  unsigned int announced; /* cycle of the last announcement */
typedef struct {
  SF_POINT
} point;
typedef struct {
  SF_POINT
  float length, width; /* [mm]; the width of a wall is 0 */
} wall;
typedef wall corridor, lane, door, junction, office;

point* sfCreateLocalPoint(float x, float y, float th);
point* sfCreateGlobalPoint(float x, float y, float th);
void sfSetLocalCoords(point* p);
void sfSetGlobalCoords(point* p);
void sfAddPoint(point* p);
void sfAddPointCheck(point* p);
#define add_point_check sfAddPointCheck
void sfRemPoint(point* p);
point* sfFindArtifact(int id);
extern point *sfGlobalOrigin, *sfRobotOrigin;
float sfNormAngle(float ang);
float sfNorm2Angle(float ang);
float sfNorm3Angle(float ang);
float sfAddAngle(float a1, float a2);
float sfSubAngle(float a1, float a2);
float sfAdd2Angle(float a1, float a2);
float sfSub2Angle(float a1, float a2);
float sfPointPhi(point* p);
float sfPointDist(point* p);
float sfPointNormalDist(point* p);
float sfPointDistPoint(point* p1, point* p2);
float sfPointNormalDistPoint(point* p, point* q);
void sfPointBaricenter(point* p1, point* p2, point* p3);
void sfChangeVP(point* p1, point* p2, point* p3);
void sfUnchangeVP(point* p1, point* p2, point* p3);
float sfPointXo(point* p);
float sfPointYo(point* p);
float sfPointXoPoint(point* p, point* q);
float sfPointYoPoint(point* p, point* q);
void sfPointMove(point* p1, float dx, float dy, point* p2);
void sfMoveRobot(float dx, float dy, float dth);
/* 8.1.3: how far the robot points along the lane at the target: 1 within near_angle, 0 beyond
 * far_angle [deg]. */
float aligned_in_lane(point* lane_point, point* target, double near_angle, double far_angle);

#define sfLeftWallHyp (*sf_wall_hypothesis(sfLEFT)) /* 6.7 */
#define sfRightWallHyp (*sf_wall_hypothesis(sfRIGHT))
wall* sf_wall_hypothesis(int side);
extern point* current_environment; /* 8.1.2; NULL: none known */

/* ---- 6.8: drawing. */

enum {
  sfColorYellow = 0, sfColorLightYellow = 3, sfColorRed = 5, sfColorLightRed = 8,
  sfColorDarkTurquoise = 10, sfColorDarkOliveGreen = 11, sfColorOrangeRed = 12,
  sfColorMagenta = 13, sfColorSteelBlue = 14, sfColorBrickRed = 15, sfColorBlack = 100,
  sfColorWhite = 101
};
void set_vector_buffer(int w);
void sfSetLineWidth(int w);
void sfSetLineType(int w);
void sfSetLineColor(int color);
void sfSetPatchColor(int color);
void sfDrawCenteredRect(float x, float y, float w, float h);
void sfDrawRect(float x, float y, float dx, float dy);

/* For programs of Saphira 6, whose header is saphira6/saphira.h: a line [mm], in the LPS... */
void sfDrawVector(float x1, float y1, float x2, float y2);
/* ...and from now on the angles of points and of the robot are degrees, and sfInitBasicProcs is
 * called with each connection. */
void sf_as_saphira6(void);

/* ---- 6.9: maps. */

int sfLoadMapFile(const char* name);
extern int add_new_features;
extern int snap_to_right_angle_grid;

/* ---- 7: behaviors. */

extern int sfBehaviorControl; /* 7.4 */
float straight_up(float x, float min, float max); /* 7.5 */
float down_straight(float x, float min, float max);
float f_greater(float x, float c, float delta);
float f_smaller(float x, float c, float delta);
float f_eq(float x, float c, float delta);
float f_not(float x);
float f_and(float x, float y);
float f_or(float x, float y);

enum { sfEND = 0x5fE0D, sfINT = 0x5f101, sfFLOAT = 0x5f102, sfPTR = 0x5f103 };
enum { sfOFF = 0, sfON = 1, sfTOGGLE = 2 };
BEHCLOSURE sfInitBehavior(behavior* b, int priority, int running, ...); /* 7.7 */
BEHCLOSURE sfInitBehaviorDup(behavior* b, int priority, int running, ...);
void sfKillBehavior(BEHCLOSURE b);
void sfSetBehaviorState(BEHCLOSURE b, int state);
void sfBehaviorOn(BEHCLOSURE b);
void sfBehaviorOff(BEHCLOSURE b);
BEHCLOSURE sfFindBehavior(const char* name);

extern behavior *sfConstantVelocity, *sfStop, *sfAvoidCollision, *sfStopCollision, *sfKeepOff,
    *sfGoToPos, *sfAttendAtPos, *sfFollow, *sfFollowCorridor, *sfFollowDoor, *sfTurnTo; /* 7.8 */
#define TurnTo sfTurnTo
extern behavior follow_corridor; /* 8.1.2: *sfFollowCorridor */
extern float flakey_radius; /* [mm] of the robot's hull; before the connection 0 */
enum { sfNOTURN, sfLEFTTURN, sfRIGHTTURN };
extern int sfPreferredTurnDir;
enum { sfIN, sfOUT };
#define sfSHARPLY 10.0 /* the fastest turn gain */

/* ---- 8.6: packets. */

enum { sfLOCALPORT = 1, sfTTYPORT = 2, sfTCPPORT = 3 };
enum { sfBUSPORT = 4 }; /* not in the manual: the name is that of a robot on the bus */
extern const char *sfCOMLOCAL, *sfCOM1, *sfCOM2;
int sfConnectToRobot(int port, const char* name);
void sfDisconnectFromRobot(void);
extern char sfRobotName[64], sfRobotClass[64], sfRobotSubclass[64];
void sfResetRobotVars(void);
void sfRobotCom(int com);
void sfRobotComInt(int com, int arg);
void sfRobotCom2Bytes(int com, int b1, int b2);
void sfRobotComStr(int com, const char* str);
void sfRobotComStrn(int com, const char* str, int n);
int sfWaitClientPacket(int ms);
int sfHaveClientPacket(void);
void sfProcessClientPacket(SF_OPTIONAL_ARGUMENT); /* 4.3.5 calls it with the packet's first byte */
int sfClientBytes(void);
int sfReadClientByte(void);
int sfReadClientSint(void);
int sfReadClientUsint(void);
int sfReadClientWord(void);
char* sfReadClientString(void);

/* 5.2, Table 5-4. */
enum {
  sfSYNC0 = 0, sfSYNC1 = 1, sfSYNC2 = 2, sfCOMSYNC = 0,
  sfCOMPULSE = 0, sfCOMOPEN = 1, sfCOMCLOSE = 2, sfCOMPOLLING = 3, sfCOMSETO = 7, sfCOMVEL = 11,
  sfCOMHEAD = 12, sfCOMDHEAD = 13, sfCOMRVEL = 21, sfCOMDIGOUT = 30, sfCOMTIMER = 31,
  sfCOMVEL2 = 32, sfCOMGRIPPER = 33, sfCOMPTUPOS = 41, VISION_COM = 53, sfCOMSTEP = 64
};
#define sfCLOSE sfCOMCLOSE
#define PULSE_COM sfCOMPULSE
#define VEL_COM sfCOMVEL
enum { sfARGINT = 0x3B, sfARGNINT = 0x1B, sfARGSTR = 0x2B };
/* 5.3: the first bytes of information packets. */
enum { sfSTATUSNOPOWER = 0x31, sfSTATUSSTOPPED = 0x32, sfSTATUSMOVING = 0x33 };

/* ---- 9: vision. */

enum { BLOB_MODE = 0, LINE_MODE = 1, BLOB_BB_MODE = 2 };
#define DEG_TO_PIXELS 3.0
struct vinfo {
  int type;       /* BLOB_MODE, BLOB_BB_MODE or LINE_MODE */
  int x, y;       /* centre of mass [pixels] */
  int area;       /* [pixels] 0: no blob */
  int h, w;       /* of the bounding box [pixels] */
  int first, num; /* lines */
};
#define sfVaInfo (*sf_vision(0))
#define sfVbInfo (*sf_vision(1))
#define sfVcInfo (*sf_vision(2))
struct vinfo* sf_vision(int channel);
void setup_vision_system(void); /* 9.3 */
int found_blob(int channel, int delta);
void draw_blobs(void);
void find_blob(void);
void search_and_go_blob(void);

#ifdef __cplusplus
}
#endif
#endif
