;; Parameters of the Erratic, a small two-wheeled robot.
;;
;; Assumed values: a light differential drive, eight sonars in front, packets in millimetres.
;; Keywords: README.md.

Class     Erratic
Protocol  psos

;; Values of one unit of the packets
AngleConvFactor  0.00153398 ; rad
DistConvFactor   1          ; mm
VelConvFactor    1          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.0056     ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      20         ; mm/s

RobotRadius      200        ; mm
RobotDiagonal    100        ; mm, half-height to the diagonal of the octagon

MaxVelocity      1000       ; mm/s
MaxRVelocity     200        ; deg/s
Acceleration     500        ; mm/s2
Deceleration     1000       ; mm/s2
RotAcceleration  200        ; deg/s2
RotDeceleration  200        ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.01
AngleJitter      0.02
AngleDrift       0.003

;; Equipment
Battery           12.6      ; V

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

SonarNum 8
SonarArrays 1   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0    69   136    90
SonarUnit  1   114   119    50
SonarUnit  2   148    78    30
SonarUnit  3   166    27    10
SonarUnit  4   166   -27   -10
SonarUnit  5   148   -78   -30
SonarUnit  6   114  -119   -50
SonarUnit  7    69  -136   -90
