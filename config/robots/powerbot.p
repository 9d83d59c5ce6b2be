;; Parameters of the PowerBot with the H8S controller.
;;
;; Conversion factors, limits and radius are the values of ARIA and Player for this subclass.
;; Accelerations, batteries, encoders and errors are assumed: plausible settings for such a robot.
;; Keywords: README.md.
;; The sonar places are assumed: two rings of sixteen around the hull.

Class     Pioneer
Subclass  powerbot
Protocol  p2os

;; Values of one unit of the packets
AngleConvFactor  0.00153398 ; rad
DistConvFactor   0.5813     ; mm
VelConvFactor    1          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.00373    ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      20         ; mm/s

RobotRadius      550        ; mm
RobotDiagonal    240        ; mm, half-height to the diagonal of the octagon
RobotWidth       680        ; mm
RobotLength      911        ; mm

MaxVelocity      2000       ; mm/s
MaxRVelocity     360        ; deg/s
Acceleration     300        ; mm/s2
Deceleration     300        ; mm/s2
RotAcceleration  100        ; deg/s2
RotDeceleration  100        ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.01
AngleJitter      0.01
AngleDrift       0.001

;; Equipment
Battery           25.2      ; V
LowBattery        23.0      ; V
ShutdownVolts     22.0      ; V
EncoderTicksPerMM 128       ; counts
NumFrontBumpers   5
NumRearBumpers    5

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

SonarNum 32
SonarArrays 4   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0     0   300    90
SonarUnit  1   270   230    50
SonarUnit  2   364   150    30
SonarUnit  3   414    52    10
SonarUnit  4   414   -52   -10
SonarUnit  5   364  -150   -30
SonarUnit  6   270  -230   -50
SonarUnit  7     0  -300   -90
SonarUnit  8     0  -300   -90
SonarUnit  9  -270  -230  -130
SonarUnit 10  -364  -150  -150
SonarUnit 11  -414   -52  -170
SonarUnit 12  -414    52   170
SonarUnit 13  -364   150   150
SonarUnit 14  -270   230   130
SonarUnit 15     0   300    90
SonarUnit 16     0   300    90
SonarUnit 17   270   230    50
SonarUnit 18   364   150    30
SonarUnit 19   414    52    10
SonarUnit 20   414   -52   -10
SonarUnit 21   364  -150   -30
SonarUnit 22   270  -230   -50
SonarUnit 23     0  -300   -90
SonarUnit 24     0  -300   -90
SonarUnit 25  -270  -230  -130
SonarUnit 26  -364  -150  -150
SonarUnit 27  -414   -52  -170
SonarUnit 28  -414    52   170
SonarUnit 29  -364   150   150
SonarUnit 30  -270   230   130
SonarUnit 31     0   300    90
