;; A robot that only speaks ROS 2, behind saphira-ros2-base (agents/ros2/README.md): a round base of the size and the
;; speed of a TurtleBot, with a laser. Copy this file for your own robot. Keywords: README.md.

Class     ROS
Subclass  ros2
Protocol  p2os

;; Values of one unit of the packets between that program and the bridge
AngleConvFactor  0.00153398 ; rad
DistConvFactor   1          ; mm
VelConvFactor    1          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.008      ; rad of turn per mm of half the difference of the wheel ways: 2 / their distance
Vel2Divisor      20         ; mm/s

;; To be adapted: the hull, and what cmd_vel may ask for
RobotRadius      180        ; mm
MaxVelocity      300        ; mm/s
MaxRVelocity     90         ; deg/s
Acceleration     300        ; mm/s2
Deceleration     500        ; mm/s2
RotAcceleration  120        ; deg/s2
RotDeceleration  120        ; deg/s2

;; The battery; without battery_state they do not matter
Battery          12.6       ; V
LowBattery       11.0       ; V
ShutdownVolts    10.5       ; V

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

;; Sectors of the laser's scan, from the robot's middle: at most 15 degrees apart, so that they leave no gap. For range
;; sensors: a line for each, with its place, as tf_static has it. No sensor may reach less far than SonarMaxRange.
SonarMaxRange    3400       ; mm
SonarPeriod      33         ; ms: with eight arrays, all within a scan of 0.1 s
SonarArrays      8
SonarNum         24
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0     0     0     0
SonarUnit  1     0     0    15
SonarUnit  2     0     0    30
SonarUnit  3     0     0    45
SonarUnit  4     0     0    60
SonarUnit  5     0     0    75
SonarUnit  6     0     0    90
SonarUnit  7     0     0   105
SonarUnit  8     0     0   120
SonarUnit  9     0     0   135
SonarUnit 10     0     0   150
SonarUnit 11     0     0   165
SonarUnit 12     0     0   180
SonarUnit 13     0     0  -165
SonarUnit 14     0     0  -150
SonarUnit 15     0     0  -135
SonarUnit 16     0     0  -120
SonarUnit 17     0     0  -105
SonarUnit 18     0     0   -90
SonarUnit 19     0     0   -75
SonarUnit 20     0     0   -60
SonarUnit 21     0     0   -45
SonarUnit 22     0     0   -30
SonarUnit 23     0     0   -15
